// Descriptors prepared for the scan: immutable, shared by all snapshots that contain them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "posevote/index/quantizer.hpp"
#include "posevote/model/view.hpp"

namespace posevote {

/// Features that come and go together: those of a view, or of one picture of the impostor pool.
struct Unit {
  std::shared_ptr<const View> view;  ///< null for impostors
  cv::Mat descriptors;               ///< shared with the view or the pool
  std::vector<std::int8_t> signs;    ///< Laplacian of each feature
  /// List of each feature among those of its sign; empty when not assigned yet.
  std::vector<std::uint16_t> lists;

  [[nodiscard]] std::size_t size() const noexcept { return signs.size(); }
  /// Equal for the same View object or the same pool picture.
  [[nodiscard]] const void* identity() const noexcept {
    return view ? static_cast<const void*>(view.get()) : descriptors.data;
  }
};

/// The coarse quantisers of the three signs.
using Quantizer = std::array<Centers, kSigns>;

/// Finds the list of every feature of the units that have none yet.
void assign_lists(const Coder& coder, const Quantizer& quantizer, std::vector<Unit>& units,
                  int threads);

/// The codes of some units, sorted by sign and list.
class Segment {
 public:
  /// Where the descriptor of a code comes from; `unit` is kNone for the filling of the last block.
  struct Entry {
    std::uint32_t unit, feature;
  };
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// Code i of list l is entry starts[l] * kBlockLanes + i.
  struct Lists {
    std::vector<std::uint32_t> starts;  ///< first block of each list, and the end
    std::vector<std::uint32_t> sizes;   ///< number of codes of each list
    std::vector<std::uint8_t> codes;
    std::vector<Entry> entries;
  };

  /// `units` have their lists.
  Segment(const Coder& coder, const Quantizer& quantizer, std::vector<Unit> units);

  [[nodiscard]] const std::vector<Unit>& units() const noexcept { return units_; }
  [[nodiscard]] const Lists& lists(std::size_t sign) const noexcept { return lists_[sign]; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// Largest residual of its codes (see Coder).
  [[nodiscard]] float largest_residual() const noexcept { return largest_residual_; }
  /// Root mean square of the residuals.
  [[nodiscard]] float usual_residual() const noexcept;
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  void fill(const Coder& coder, const Centers& centers, std::size_t sign);

  std::vector<Unit> units_;
  std::array<Lists, kSigns> lists_;
  std::size_t size_ = 0;
  float largest_residual_ = 0;
  double squared_residuals_ = 0;
};

}  // namespace posevote
