// The coarse quantiser of the inverted file: which lists of descriptors are worth a look.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "posevote/index/codes.hpp"
#include "posevote/index/dots.hpp"

namespace posevote {

/// Descriptors of opposite Laplacian signs are never neighbours, so each sign has lists of its own:
/// class 0 is -1, class 1 is 0 (not known), class 2 is +1.
inline constexpr std::size_t kSigns = 3;

[[nodiscard]] inline std::size_t sign_class(int laplacian) noexcept {
  return laplacian < 0 ? 0 : laplacian == 0 ? 1 : 2;
}

/// Unit vectors, each the middle of one list. Assigning is deterministic: largest scalar product of
/// the codes, then the lower list. Without centres there is one list.
class Centers {
 public:
  Centers() = default;
  /// Centres from what `codes()` and `member_scale()` returned.
  Centers(const Coder& coder, std::size_t count, std::vector<std::uint8_t> codes,
          float member_scale);

  /// Spherical k-means over `sample_count` rows, read by `row(i, buffer)`; starts from evenly
  /// spaced rows, so that it is deterministic. Needs 1 <= count <= min(sample_count, 65536).
  using ReadRow = std::function<const float*(std::size_t i, std::vector<float>& buffer)>;
  static Centers train(const Coder& coder, std::size_t count, std::size_t sample_count,
                       const ReadRow& row, int threads);

  [[nodiscard]] std::size_t lists() const noexcept { return count_ == 0 ? 1 : count_; }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] const std::vector<std::uint8_t>& codes() const noexcept { return codes_; }

  /// Scale of the codes of what the lists hold, less the centres.
  [[nodiscard]] float member_scale() const noexcept { return member_scale_; }

  /// The centre of a list; null: 0.
  [[nodiscard]] const float* center(std::size_t list) const noexcept {
    return count_ == 0 ? nullptr : &values_[list * (values_.size() / count_)];
  }

  /// The list of each of `row_count` rows.
  void assign(const Coder& coder, std::size_t row_count, const ReadRow& row, std::uint16_t* lists,
              int threads) const;

  /// A list and the scalar product of the codes of a query and of its centre (0 without centres).
  struct Probe {
    std::uint16_t list;
    std::int16_t product;
  };

  /// Memory that `nearest` uses again.
  struct Buffer {
    std::vector<std::int16_t> products;
    std::vector<std::uint32_t> positions;
  };

  /// The min(probes, lists()) nearest lists of each query, the nearest first, the others in rising
  /// order. `found`: queries.count rows of that many.
  void nearest(const Coder& coder, const QueryGroup& queries, std::size_t probes, Buffer& buffer,
               Probe* found) const;

 private:
  [[nodiscard]] std::size_t padded() const noexcept {
    return (count_ + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
  }

  std::size_t count_ = 0;
  std::vector<std::uint8_t> codes_;  ///< blocks as in dots.hpp
  std::vector<float> values_;        ///< what the codes stand for
  float member_scale_ = kUnitScale;
};

}  // namespace posevote
