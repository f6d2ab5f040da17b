#include "posevote/match/look_alikes.hpp"

#include <algorithm>
#include <map>
#include <string>

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
    cv::Mat rows;
    all.descriptors.rowRange(0, count).convertTo(rows, CV_32F);
    sample.descriptors.push_back(rows);
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

/// For each object its place in `before`, -1 when it is not there with the same views.
std::vector<int> places_before(const ModelSet& models, const LookAlikes* before) {
  std::vector<int> places(models.objects().size(), -1);
  if (before == nullptr) return places;
  std::map<std::string, int> by_name;
  const auto& known = before->models->objects();
  for (std::size_t i = 0; i < known.size(); ++i) by_name[known[i].name] = static_cast<int>(i);
  for (std::size_t a = 0; a < places.size(); ++a) {
    const ObjectModel& object = models.objects()[a];
    const auto at = by_name.find(object.name);
    if (at != by_name.end() && known[static_cast<std::size_t>(at->second)].views == object.views)
      places[a] = at->second;
  }
  return places;
}

/// Marks the objects on which a good part of the sample is found.
void mark_look_alikes(std::size_t object, const Features& sample, const Index& index,
                      LookAlikes& result) {
  const std::size_t count = result.models->objects().size();
  const NeighborLists lists = index.search(sample, kNeighbors);
  std::map<int, int> shared;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const auto others = others_of(static_cast<int>(object), lists[i], *result.models);
    if (others.empty() || others[0].first < 0) continue;
    const float third = others.size() > 1 ? others[1].second : lists[i].back().distance;
    if (others[0].second < kShared * third) ++shared[others[0].first];
  }
  for (const auto& [other, number] : shared) {
    if (number <= kGoodPart * static_cast<double>(sample.size())) continue;
    const auto b = static_cast<std::size_t>(other);
    result.table[object * count + b] = result.table[b * count + object] = 1;
  }
}

}  // namespace

LookAlikes find_look_alikes(const std::shared_ptr<const ModelSet>& models, const Index& index,
                            const LookAlikes* before) {
  const std::size_t count = models->objects().size();
  LookAlikes result{models, std::vector<char>(count * count, 0)};
  const std::vector<int> places = places_before(*models, before);
  for (std::size_t a = 0; a < count && count > 1; ++a) {
    if (places[a] < 0) {
      const Features sample = sample_of(models->objects()[a]);
      if (sample.size() > 0) mark_look_alikes(a, sample, index, result);
      continue;
    }
    const std::size_t row = static_cast<std::size_t>(places[a]) * before->models->objects().size();
    for (std::size_t b = 0; b < count; ++b)
      if (places[b] >= 0 && before->table[row + static_cast<std::size_t>(places[b])])
        result.table[a * count + b] = 1;
  }
  return result;
}

std::vector<int> group_views(const ModelSet& models, const std::vector<char>& table) {
  const std::size_t count = models.objects().size();
  std::vector<int> group(count, -1);
  for (std::size_t first = 0; first < count; ++first) {
    if (group[first] >= 0) continue;
    group[first] = static_cast<int>(first);
    std::vector<std::size_t> open{first};
    while (!table.empty() && !open.empty()) {
      const std::size_t row = open.back() * count;
      open.pop_back();
      for (std::size_t other = first + 1; other < count; ++other) {
        if (table[row + other] == 0 || group[other] >= 0) continue;
        group[other] = static_cast<int>(first);
        open.push_back(other);
      }
    }
  }
  std::vector<int> groups;
  for (const auto& view : models.views())
    groups.push_back(group[static_cast<std::size_t>(view.object)]);
  return groups;
}

}  // namespace posevote
