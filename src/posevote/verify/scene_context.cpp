#include "posevote/verify/scene_context.hpp"

#include <algorithm>
#include <limits>

#include "posevote/index/dots.hpp"

namespace posevote {
SceneRivals::SceneRivals(const ModelSet& models, const Features& scene, int rank)
    : models_(models), coder_(scene.descriptors.cols), distances_(models.views().size()) {
  constexpr int kSample = 1000;  // the strongest; enough to tell common from rare
  const int count = std::min(kSample, static_cast<int>(scene.size()));
  rank_ = static_cast<std::size_t>(std::min(rank, count));
  for (int s = 0; s < count; ++s) rows_.push_back(scene.descriptors.ptr<float>(s));
}

// The nearest few by their codes are measured.
float SceneRivals::nth_distance(const float* taught) {
  constexpr std::size_t kAtLeast = 4;  // times the rank
  if (codes_.empty()) {
    codes_ = coder_.encode_all(rows_);
    query_.resize(coder_.quads() * 4);
    products_.resize(codes_.size() / coder_.block_bytes() * kBlockLanes);
    positions_.resize(products_.size());
  }
  coder_.encode_query(taught, query_.data());
  dots(codes_.data(), products_.size() / kBlockLanes, coder_.quads(), {{query_.data()}, 1},
       products_.data(), products_.size());
  std::fill(products_.begin() + static_cast<std::ptrdiff_t>(rows_.size()), products_.end(),
            std::numeric_limits<std::int16_t>::min());
  const std::int16_t limit =
      kth_largest(products_.data(), products_.size(), std::min(kAtLeast * rank_, rows_.size()));
  const std::size_t found =
      find_at_least(products_.data(), products_.size(), limit, positions_.data());
  chosen_.clear();
  for (std::size_t i = 0; i < found; ++i) chosen_.push_back(rows_[positions_[i]]);
  nearest_.resize(found);
  distances(taught, chosen_.data(), found, static_cast<std::size_t>(coder_.dimension()),
            nearest_.data());
  const auto nth = nearest_.begin() + static_cast<std::ptrdiff_t>(rank_) - 1;
  std::ranges::nth_element(nearest_, nth);
  return *nth;
}

Reference SceneRivals::reference(int view, int feature) {
  auto& of_view = distances_[static_cast<std::size_t>(view)];
  if (of_view.empty())
    of_view.assign(models_.views()[static_cast<std::size_t>(view)].view->features.size(), -1.F);
  float& distance = of_view[static_cast<std::size_t>(feature)];
  if (distance < 0) distance = nth_distance(taught_row(view, feature));
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
