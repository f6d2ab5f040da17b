// Scene features by place: which lie near a point, which in a rectangle.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "posevote/feature/features.hpp"

namespace posevote {

/// Buckets of the key points of one scene; immutable. The features must outlive it.
class SceneGrid {
 public:
  explicit SceneGrid(const Features& scene, cv::Size scene_size);

  [[nodiscard]] const Features& features() const noexcept { return scene_; }
  [[nodiscard]] cv::Size size() const noexcept { return size_; }

  /// Calls visit(index) for every feature within `radius` px of `point`.
  template <class Visit>
  void for_each_near(cv::Point2f point, float radius, Visit&& visit) const {
    const int x1 = column(point.x + radius), y1 = row(point.y + radius);
    for (int y = row(point.y - radius); y <= y1; ++y)
      for (int x = column(point.x - radius); x <= x1; ++x)
        for (int i = begin(x, y); i < begin(x, y) + count(x, y); ++i) {
          const int index = order_[static_cast<std::size_t>(i)];
          const Keypoint& k = scene_.keypoints[static_cast<std::size_t>(index)];
          const float dx = k.x - point.x, dy = k.y - point.y;
          if (dx * dx + dy * dy <= radius * radius) visit(index);
        }
  }

  /// Number of features in the rectangle: f_t of Eq. 11.
  [[nodiscard]] int count_in(const cv::Rect2d& box) const;

 private:
  [[nodiscard]] int column(float x) const;
  [[nodiscard]] int row(float y) const;
  [[nodiscard]] std::size_t cell(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] int begin(int x, int y) const { return starts_[cell(x, y)]; }
  [[nodiscard]] int count(int x, int y) const {
    return starts_[cell(x, y) + 1] - starts_[cell(x, y)];
  }

  const Features& scene_;
  cv::Size size_;
  int columns_ = 1, rows_ = 1;
  std::vector<int> starts_;  ///< of each cell in order_, with one more at the end
  std::vector<int> order_;
};

}  // namespace posevote
