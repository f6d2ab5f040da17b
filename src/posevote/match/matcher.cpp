#include "posevote/match/matcher.hpp"

#include <algorithm>
#include <cmath>

namespace posevote {

void MatchOptions::describe(OptionList& list) {
  list.add("neighbors", neighbors, {2, 200}, "",
           "Nearest taught descriptors looked at for each feature of the scene.");
  list.add("max_ratio", max_ratio, {0.1, 2}, "",
           "A match needs a descriptor distance below this share of the distance to the nearest "
           "descriptor of another object.");
}

Neighborhood::Neighborhood(NeighborLists neighbors, const ModelSet& models,
                           std::vector<char> related)
    : neighbors_(std::move(neighbors)),
      models_(models),
      related_(std::move(related)),
      all_features_(static_cast<double>(models.feature_count())) {
  for (const auto& pool : models.impostors()) all_features_ += static_cast<double>(pool.size());
}

bool Neighborhood::related(int object, int other) const {
  if (object == other) return true;
  if (related_.empty()) return false;
  const auto count = models_.objects().size();
  return related_[static_cast<std::size_t>(object) * count + static_cast<std::size_t>(other)] != 0;
}

bool Neighborhood::shows_same_spot(const Neighbor& neighbor, int view, int feature) const {
  if (neighbor.view < 0) return false;
  const auto& views = models_.views();
  const auto& own = views[static_cast<std::size_t>(view)];
  if (neighbor.view != view)
    return related(own.object, views[static_cast<std::size_t>(neighbor.view)].object);
  const auto& keypoints = own.view->features.keypoints;
  const Keypoint& a = keypoints[static_cast<std::size_t>(feature)];
  const Keypoint& b = keypoints[static_cast<std::size_t>(neighbor.feature)];
  const float near = std::max(4.F, 2 * std::max(a.scale, b.scale));
  return std::abs(a.x - b.x) < near && std::abs(a.y - b.y) < near;
}

Reference Neighborhood::reference(int scene_feature, int view, int feature) const {
  const NeighborList list = neighbors_[static_cast<std::size_t>(scene_feature)];
  const double population = std::max(1.0, all_features_);
  for (const Neighbor& neighbor : list)
    if (!shows_same_spot(neighbor, view, feature)) return {neighbor.distance, 1 / population};
  if (list.empty()) return {};
  return {list.back().distance, static_cast<double>(list.size()) / population};
}

std::vector<Match> match_features(const Neighborhood& neighborhood, const MatchOptions& options) {
  std::vector<Match> matches;
  const auto& lists = neighborhood.neighbors();
  for (int scene = 0; scene < static_cast<int>(lists.size()); ++scene)
    for (const Neighbor& neighbor : lists[static_cast<std::size_t>(scene)]) {
      if (neighbor.view < 0) continue;
      const float reference =
          neighborhood.reference(scene, neighbor.view, neighbor.feature).distance;
      if (neighbor.distance > options.max_ratio * reference) continue;
      const float ratio = reference > 0 ? neighbor.distance / reference : 1.F;
      matches.push_back({scene, neighbor.view, neighbor.feature, neighbor.distance, ratio});
    }
  return matches;
}

}  // namespace posevote
