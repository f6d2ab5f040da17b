#include "posevote/verify/scene_context.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace posevote {

SceneRivals::SceneRivals(const ModelSet& models, const Features& scene, int rank)
    : models_(models), scene_(scene), rank_(rank), distances_(models.views().size()) {}

Reference SceneRivals::reference(int view, int feature) {
  const Features& known = models_.views()[static_cast<std::size_t>(view)].view->features;
  auto& of_view = distances_[static_cast<std::size_t>(view)];
  if (of_view.empty()) of_view.assign(known.size(), -1.F);
  float& distance = of_view[static_cast<std::size_t>(feature)];
  constexpr int kSample = 1000;  // the strongest; enough to tell common from rare
  const int count = std::min(kSample, static_cast<int>(scene_.size()));
  const int rank = std::min(rank_, count);
  if (distance < 0) {
    buffer_.resize(static_cast<std::size_t>(count));
    for (int s = 0; s < count; ++s)
      buffer_[static_cast<std::size_t>(s)] =
          descriptor_distance(scene_.descriptors, s, known.descriptors, feature);
    std::ranges::nth_element(buffer_, buffer_.begin() + rank - 1);
    distance = buffer_[static_cast<std::size_t>(rank - 1)];
  }
  return {distance, static_cast<double>(rank) / std::max(1, count)};
}

float descriptor_distance(const cv::Mat& a, int row_a, const cv::Mat& b, int row_b) {
  const float* pa = a.ptr<float>(row_a);
  const float* pb = b.ptr<float>(row_b);
  // Independent sums, so that the compiler may use vector registers.
  std::array<float, 16> sums{};
  int i = 0;
  for (; i + 16 <= a.cols; i += 16)
    for (int j = 0; j < 16; ++j) {
      const float difference = pa[i + j] - pb[i + j];
      sums[static_cast<std::size_t>(j)] += difference * difference;
    }
  float sum = 0;
  for (; i < a.cols; ++i) sum += (pa[i] - pb[i]) * (pa[i] - pb[i]);
  for (const float part : sums) sum += part;
  return std::sqrt(sum);
}

}  // namespace posevote
