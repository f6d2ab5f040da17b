#include "posevote/verify/scene_context.hpp"

#include <algorithm>

#include "posevote/index/codes.hpp"
#include "posevote/index/dots.hpp"

namespace posevote {
namespace {

/// The `rank`-th smallest, where rank is small; `smallest` is room to work in.
float nth_smallest(const std::vector<float>& values, std::size_t rank,
                   std::vector<float>& smallest) {
  smallest.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank));
  std::ranges::sort(smallest);
  for (std::size_t i = rank; i < values.size(); ++i) {
    if (!(values[i] < smallest.back())) continue;
    smallest.pop_back();
    smallest.insert(std::ranges::upper_bound(smallest, values[i]), values[i]);
  }
  return smallest.back();
}

}  // namespace

SceneRivals::SceneRivals(const ModelSet& models, const Features& scene, int rank)
    : models_(models),
      dimension_(static_cast<std::size_t>(scene.descriptors.cols)),
      distances_(models.views().size()) {
  constexpr int kSample = 1000;  // the strongest; enough to tell common from rare
  const int count = std::min(kSample, static_cast<int>(scene.size()));
  for (int s = 0; s < count; ++s) rows_.push_back(scene.descriptors.ptr<float>(s));
  rank_ = static_cast<std::size_t>(std::min(rank, count));
  to_all_.resize(rows_.size());
}

Reference SceneRivals::reference(int view, int feature) {
  auto& of_view = distances_[static_cast<std::size_t>(view)];
  if (of_view.empty())
    of_view.assign(models_.views()[static_cast<std::size_t>(view)].view->features.size(), -1.F);
  float& distance = of_view[static_cast<std::size_t>(feature)];
  if (distance < 0) {
    distances(taught_row(view, feature), rows_.data(), rows_.size(), dimension_, to_all_.data());
    distance = nth_smallest(to_all_, rank_, nearest_);
  }
  return {distance, static_cast<double>(rank_) / static_cast<double>(rows_.size())};
}

const float* SceneRivals::taught_row(int view, int feature) {
  const Features& known = models_.views()[static_cast<std::size_t>(view)].view->features;
  return read_row(known.descriptors, feature, row_);
}

float descriptor_distance(const cv::Mat& descriptors, int i, const float* other) {
  float distance = 0;
  distances(descriptors.ptr<float>(i), &other, 1, static_cast<std::size_t>(descriptors.cols),
            &distance);
  return distance;
}

}  // namespace posevote
