// Which taught features a scene feature may be: neighbours, judged against other objects.
#pragma once

#include <vector>

#include "posevote/core/options.hpp"
#include "posevote/index/neighbors.hpp"
#include "posevote/model/model_set.hpp"

namespace posevote {

struct MatchOptions {
  int neighbors = 24;      ///< nearest taught descriptors looked at per scene feature
  double max_ratio = 0.9;  ///< distance / distance to the nearest descriptor of another object
  void describe(OptionList& list);
};

/// A scene feature that may be a taught feature.
struct Match {
  int scene = 0;       ///< index of the scene's feature
  int view = 0;        ///< index into ModelSet::views()
  int feature = 0;     ///< index into the view's features
  float distance = 0;  ///< Euclidean distance of the descriptors
  float ratio = 0;     ///< distance / reference distance, see Neighborhood
};

/// How near a descriptor that means nothing may come to one scene feature: `rank` of `population`
/// descriptors of other objects (or of the pool) lie within `distance`.
struct Reference {
  float distance = 0;
  double rate = 1;  ///< rank / population: chance of one random descriptor to lie within `distance`
};

/// The neighbours of every scene feature, and what they say about chance. The reference for an
/// object is the nearest descriptor that belongs to another, unrelated object or to the impostor
/// pool (Lowe 2004, 7.1). With nothing else taught the farthest neighbour looked at is the
/// reference: among the many features of one object only few show the same spot, so it is a wrong
/// one as well.
class Neighborhood {
 public:
  /// `related[a * objects + b]` is non-zero when object b looks like a in parts: its descriptors
  /// are then no reference for a. Empty: none are related.
  Neighborhood(NeighborLists neighbors, const ModelSet& models, std::vector<char> related = {});

  [[nodiscard]] const NeighborLists& neighbors() const { return neighbors_; }
  [[nodiscard]] Reference reference(int scene_feature, int view, int feature) const;
  [[nodiscard]] bool related(int object, int other) const;

 private:
  NeighborLists neighbors_;
  const ModelSet& models_;
  std::vector<char> related_;
  double all_features_ = 0;  ///< number of descriptors, with the pool

  [[nodiscard]] bool shows_same_spot(const Neighbor& neighbor, int view, int feature) const;
};

/// All neighbours that pass the ratio, in order of scene feature, then distance. One scene feature
/// may match several views of an object, several objects that are related, and several features of
/// one view.
[[nodiscard]] std::vector<Match> match_features(const Neighborhood& neighborhood,
                                                const MatchOptions& options);

}  // namespace posevote
