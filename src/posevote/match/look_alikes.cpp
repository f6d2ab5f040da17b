#include "posevote/match/look_alikes.hpp"

#include <algorithm>
#include <map>

namespace posevote {
namespace {

constexpr int kSample = 64;      // features of an object
constexpr int kNeighbors = 64;   // enough to see beyond a dozen views of two objects
constexpr double kShared = 0.6;  // distance on the other object / on a third: surely the same print
constexpr double kGoodPart = 0.3;  // of the sample

/// The strongest features of views evenly spread over the object.
Features sample_of(const ObjectModel& object) {
  Features sample;
  const std::size_t views = std::min<std::size_t>(object.views.size(), kSample / 8);
  for (std::size_t v = 0; v < views; ++v) {
    const Features& all = object.views[v * object.views.size() / views]->features;
    const int count = std::min(static_cast<int>(all.size()), kSample / static_cast<int>(views));
    if (count == 0) continue;
    sample.keypoints.insert(sample.keypoints.end(), all.keypoints.begin(),
                            all.keypoints.begin() + count);
    sample.descriptors.push_back(all.descriptors.rowRange(0, count));
  }
  return sample;
}

/// Distance of the nearest neighbour on each other object (-1: the pool), nearest first.
std::vector<std::pair<int, float>> others_of(int object, const NeighborList& neighbors,
                                             const ModelSet& models) {
  std::vector<std::pair<int, float>> others;
  for (const Neighbor& neighbor : neighbors) {
    const int other =
        neighbor.view < 0 ? -1 : models.views()[static_cast<std::size_t>(neighbor.view)].object;
    const bool known = other == object || std::ranges::any_of(others, [&](const auto& earlier) {
                         return earlier.first == other;
                       });
    if (!known) others.emplace_back(other, neighbor.distance);
  }
  return others;
}

}  // namespace

std::vector<char> find_look_alikes(const ModelSet& models, const Index& index) {
  const std::size_t count = models.objects().size();
  std::vector<char> related(count * count, 0);
  if (count < 2) return related;
  for (std::size_t a = 0; a < count; ++a) {
    const Features sample = sample_of(models.objects()[a]);
    if (sample.size() == 0) continue;
    const NeighborLists lists = index.search(sample, kNeighbors);
    std::map<int, int> shared;
    for (std::size_t i = 0; i < lists.size(); ++i) {
      const auto others = others_of(static_cast<int>(a), lists[i], models);
      if (others.empty() || others[0].first < 0) continue;
      const float third = others.size() > 1 ? others[1].second : lists[i].back().distance;
      if (others[0].second < kShared * third) ++shared[others[0].first];
    }
    for (const auto& [b, number] : shared)
      if (number > kGoodPart * static_cast<double>(sample.size()))
        related[a * count + static_cast<std::size_t>(b)] =
            related[static_cast<std::size_t>(b) * count + a] = 1;
  }
  return related;
}

}  // namespace posevote
