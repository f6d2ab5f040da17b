// Nearest neighbours of scene descriptors among all descriptors of a ModelSet.
#pragma once

#include <memory>
#include <vector>

#include "posevote/core/options.hpp"
#include "posevote/model/model_set.hpp"

namespace posevote {

/// A taught descriptor near a scene descriptor.
struct Neighbor {
  int view = -1;       ///< index into ModelSet::views(); -1: a feature of the impostor pool
  int feature = -1;    ///< index into the view's features (or into the pool, counted through)
  float distance = 0;  ///< Euclidean, descriptors have length 1, so in [0, 2]
};

struct IndexOptions {
  std::string method = "auto";  ///< "auto", "exact" or "approximate"
  void describe(OptionList& list);
};

/// Immutable; safe to search from many threads; deterministic.
class Index {
 public:
  virtual ~Index() = default;

  /// For each row of `scene.descriptors` its `k` nearest taught descriptors, nearest first (fewer
  /// when there are fewer). Descriptors whose Laplacian signs are known and differ are never
  /// neighbours. Equal distances: lower view, then lower feature first; the pool comes last.
  [[nodiscard]] virtual std::vector<std::vector<Neighbor>> search(const Features& scene,
                                                                  int k) const = 0;
};

/// Indexes all features of `models`, which is kept alive. Descriptors of views that `previous`
/// holds already (the same View object) are not prepared again.
[[nodiscard]] std::shared_ptr<const Index> make_index(std::shared_ptr<const ModelSet> models,
                                                      const IndexOptions& options = {},
                                                      const Index* previous = nullptr);

}  // namespace posevote
