// The index behind `make_index`: lists of 8-bit codes, scanned and then ranked by exact distances.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "posevote/index/index.hpp"
#include "posevote/index/segment.hpp"

namespace posevote {

class ListIndex : public Index {
 public:
  /// What neighbours of a unit are called in this snapshot.
  struct Number {
    bool present = false;  ///< false: the unit is no longer in the models
    int view = -1;
    int first = 0;  ///< added to the feature's index (for the pool)
  };

  /// A segment with the numbers of its units.
  struct Part {
    std::shared_ptr<const Segment> segment;
    std::vector<Number> numbers;
  };

  /// Nothing to find: descriptors have no dimension.
  ListIndex() = default;
  ListIndex(std::string signature, const IndexOptions& options, const Coder& coder,
            std::shared_ptr<const Quantizer> quantizer, std::vector<Part> parts,
            std::size_t assigned);

  [[nodiscard]] NeighborLists search(const Features& scene, int k) const override;
  [[nodiscard]] NeighborLists search_rivals(const Features& scene, int k,
                                            const std::vector<int>& groups) const override;
  [[nodiscard]] std::string save() const override;
  [[nodiscard]] IndexStatistics statistics() const override;

  [[nodiscard]] const IndexOptions& options() const noexcept { return options_; }
  [[nodiscard]] const Coder& coder() const noexcept { return coder_; }
  [[nodiscard]] const std::shared_ptr<const Quantizer>& quantizer() const noexcept {
    return quantizer_;
  }
  [[nodiscard]] const std::vector<Part>& parts() const noexcept { return parts_; }

 private:
  [[nodiscard]] NeighborLists search_all(const Features& scene, int k,
                                         const std::vector<int>* groups) const;

  std::string signature_;
  IndexOptions options_;
  Coder coder_{0};
  std::shared_ptr<const Quantizer> quantizer_;
  std::vector<Part> parts_;
  std::size_t assigned_ = 0;
};

/// What `Index::save` wrote.
struct SavedLists {
  std::shared_ptr<const Quantizer> quantizer;                 ///< null: the bytes were of no use
  std::map<std::uint64_t, std::vector<std::uint16_t>> units;  ///< list of each feature, by key
};

[[nodiscard]] SavedLists read_saved(const std::string& bytes, const std::string& signature,
                                    const Coder& coder);

/// By what a unit is known in saved bytes.
[[nodiscard]] std::uint64_t saved_key(const Unit& unit);

}  // namespace posevote
