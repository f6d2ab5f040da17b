#include "posevote/verify/scene_grid.hpp"

#include <algorithm>
#include <cmath>

namespace posevote {
namespace {

constexpr float kCell = 16;  // px; about the search radius of guided matching

int clamp_cell(float position, int cells) {
  // A comparison with NaN is false: it goes to cell 0, and the distance test drops it.
  const float cell = std::floor(position / kCell);
  if (!(cell > 0)) return 0;
  return cell >= static_cast<float>(cells - 1) ? cells - 1 : static_cast<int>(cell);
}

}  // namespace

SceneGrid::SceneGrid(const Features& scene, cv::Size scene_size)
    : scene_(scene),
      size_(scene_size),
      columns_(scene_size.width / static_cast<int>(kCell) + 1),
      rows_(scene_size.height / static_cast<int>(kCell) + 1),
      starts_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0),
      placed_(scene.size()) {
  if (!scene_.empty())
    least_scale_ = std::ranges::min(scene_.keypoints, {}, &Keypoint::scale).scale;
  for (const auto& k : scene_.keypoints) ++starts_[cell(column(k.x), row(k.y)) + 1];
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  std::vector<int> next(starts_.begin(), starts_.end() - 1);
  for (std::size_t i = 0; i < scene_.size(); ++i) {
    const Keypoint& k = scene_.keypoints[i];
    placed_[static_cast<std::size_t>(next[cell(column(k.x), row(k.y))]++)] = {
        k.x, k.y, k.scale, std::cos(k.angle), std::sin(k.angle), static_cast<int>(i), k.laplacian};
  }
}

int SceneGrid::column(float x) const {
  return clamp_cell(x, columns_);
}
int SceneGrid::row(float y) const {
  return clamp_cell(y, rows_);
}

int SceneGrid::count_in(const cv::Rect2d& box) const {
  return static_cast<int>(std::ranges::count_if(scene_.keypoints, [&](const Keypoint& k) {
    return k.x >= box.x && k.x <= box.x + box.width && k.y >= box.y && k.y <= box.y + box.height;
  }));
}

}  // namespace posevote
