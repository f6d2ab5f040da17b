// Nearest neighbours of scene descriptors among all descriptors of a ModelSet.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "posevote/core/options.hpp"
#include "posevote/index/neighbors.hpp"
#include "posevote/model/model_set.hpp"

namespace posevote {

struct IndexOptions {
  std::string method = "auto";  ///< "auto", "exact" or "approximate"
  int scan_limit = 4000;  ///< "auto" scans all descriptors of a Laplacian sign up to this many
  int probes = 32;        ///< lists that are looked through for each scene feature
  int threads = 1;        ///< the answers do not depend on it
  void describe(OptionList& list);
};

/// What an index consists of.
struct IndexStatistics {
  std::size_t descriptors = 0;  ///< that can be found
  std::size_t lists = 0;        ///< of the inverted file; 1 to 3 when all descriptors are scanned
  std::size_t segments = 0;     ///< parts prepared at different times
  std::size_t bytes = 0;        ///< memory beside the features themselves
  /// Descriptors whose list had to be found when the index was made: none of the saved or previous
  /// one's work could be used for them.
  std::size_t assigned = 0;
};

/// Immutable; safe to search from many threads; deterministic.
class Index {
 public:
  virtual ~Index() = default;

  /// For each row of `scene.descriptors` its `k` nearest taught descriptors, nearest first (fewer
  /// when there are fewer, or when "approximate" finds fewer). Descriptors whose Laplacian signs
  /// are known and differ are never neighbours. Equal distances: lower view, then lower feature
  /// first; the pool comes last. Distances are exact for every method. Throws
  /// Error{feature_mismatch} when the scene's descriptors have another length.
  [[nodiscard]] virtual NeighborLists search(const Features& scene, int k) const = 0;

  /// What a ratio test needs of `search`, in half the time: a list ends with its first neighbour
  /// whose group is another than the first one's. `groups` has a number >= 0 for each view; the
  /// pool is a group of its own. "approximate" need not find quite the same as in `search`.
  [[nodiscard]] virtual NeighborLists search_rivals(const Features& scene, int k,
                                                    const std::vector<int>& groups) const = 0;

  /// What `load_index` needs to be ready without learning the lists again: about 2 bytes for each
  /// descriptor.
  [[nodiscard]] virtual std::string save() const = 0;

  [[nodiscard]] virtual IndexStatistics statistics() const = 0;
};

/// Indexes all features of `models`; their descriptors may be CV_32F or CV_16F. Descriptors of
/// views that `previous` holds already (the same View object) are not prepared again, and its lists
/// are kept until they fit badly (16 times more or fewer descriptors than they were made for).
[[nodiscard]] std::shared_ptr<const Index> make_index(const std::shared_ptr<const ModelSet>& models,
                                                      const IndexOptions& options = {},
                                                      const Index* previous = nullptr);

/// As `make_index`, with the work that `saved` (from `Index::save`) holds already. It may be of an
/// older or newer state of the models: views are known again by their hash (by their content if
/// they have none), others are added. Bytes that are damaged, of another version of this library or
/// of another kind of feature are of no use and ignored.
[[nodiscard]] std::shared_ptr<const Index> load_index(const std::shared_ptr<const ModelSet>& models,
                                                      const std::string& saved,
                                                      const IndexOptions& options = {});

}  // namespace posevote
