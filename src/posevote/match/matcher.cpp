#include "posevote/match/matcher.hpp"

#include <algorithm>

namespace posevote {

void MatchOptions::describe(OptionList& list) {
  list.add("neighbors", neighbors, {2, 200}, "",
           "Nearest taught descriptors looked at for each feature of the scene.");
  list.add("max_ratio", max_ratio, {0.1, 2}, "",
           "A match needs a descriptor distance below this share of the distance to the nearest "
           "descriptor of another object.");
}

Neighborhood::Neighborhood(std::vector<std::vector<Neighbor>> neighbors, const ModelSet& models,
                           std::vector<char> related)
    : neighbors_(std::move(neighbors)),
      models_(models),
      related_(std::move(related)),
      features_of_object_(models.objects().size(), 0.0) {
  for (const auto& entry : models.views())
    features_of_object_[static_cast<std::size_t>(entry.object)] +=
        static_cast<double>(entry.view->features.size());
  for (const double count : features_of_object_) all_features_ += count;
  for (const auto& pool : models.impostors()) all_features_ += static_cast<double>(pool.size());
}

bool Neighborhood::related(int object, int other) const {
  if (object == other) return true;
  if (related_.empty()) return false;
  const auto count = models_.objects().size();
  return related_[static_cast<std::size_t>(object) * count + static_cast<std::size_t>(other)] != 0;
}

Reference Neighborhood::reference(int scene_feature, int object) const {
  const auto& list = neighbors_[static_cast<std::size_t>(scene_feature)];
  if (list.empty()) return {};
  double population = all_features_ - features_of_object_[static_cast<std::size_t>(object)];
  for (const Neighbor& neighbor : list) {
    if (neighbor.view >= 0 &&
        related(object, models_.views()[static_cast<std::size_t>(neighbor.view)].object))
      continue;
    return {neighbor.distance, 1.0 / std::max(1.0, population)};
  }
  const double rank = static_cast<double>(list.size());
  return {list.back().distance, std::min(1.0, rank / std::max(1.0, all_features_))};
}

std::vector<Match> match_features(const Neighborhood& neighborhood, const ModelSet& models,
                                  const MatchOptions& options) {
  std::vector<Match> matches;
  const auto& lists = neighborhood.neighbors();
  for (int scene = 0; scene < static_cast<int>(lists.size()); ++scene) {
    int known_object = -1;
    Reference reference;
    for (const Neighbor& neighbor : lists[static_cast<std::size_t>(scene)]) {
      if (neighbor.view < 0) continue;
      const int object = models.views()[static_cast<std::size_t>(neighbor.view)].object;
      if (object != known_object) {
        reference = neighborhood.reference(scene, object);
        known_object = object;
      }
      if (neighbor.distance > options.max_ratio * reference.distance) continue;
      const float ratio = reference.distance > 0 ? neighbor.distance / reference.distance : 1.F;
      matches.push_back({scene, neighbor.view, neighbor.feature, neighbor.distance, ratio});
    }
  }
  return matches;
}

}  // namespace posevote
