// Scene features by place: which lie near a point, which in a rectangle.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "posevote/feature/features.hpp"

namespace posevote {

/// A key point of the scene as guided matching reads it.
struct PlacedKeypoint {
  float x, y, scale;
  float cosine, sine;  ///< of its angle
  int index;           ///< into the scene's features
  std::int8_t laplacian;
};

/// Buckets of the key points of one scene; immutable. The features must outlive it.
class SceneGrid {
 public:
  explicit SceneGrid(const Features& scene, cv::Size scene_size);

  [[nodiscard]] const Features& features() const noexcept { return scene_; }
  [[nodiscard]] cv::Size size() const noexcept { return size_; }

  /// The smallest scale of a feature; 0 when there is none.
  [[nodiscard]] float least_scale() const noexcept { return least_scale_; }

  /// Calls visit(PlacedKeypoint) for every feature within `radius` px of `point`.
  template <class Visit>
  void for_each_near(cv::Point2f point, float radius, Visit&& visit) const {
    const int x0 = column(point.x - radius), x1 = column(point.x + radius);
    const int y1 = row(point.y + radius);
    for (int y = row(point.y - radius); y <= y1; ++y)
      for (int i = starts_[cell(x0, y)]; i < starts_[cell(x1, y) + 1]; ++i) {
        const PlacedKeypoint& k = placed_[static_cast<std::size_t>(i)];
        const float dx = k.x - point.x, dy = k.y - point.y;
        if (dx * dx + dy * dy <= radius * radius) visit(k);
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

  const Features& scene_;
  cv::Size size_;
  float least_scale_ = 0;
  int columns_ = 1, rows_ = 1;
  std::vector<int> starts_;             ///< of each cell in placed_, with one more at the end
  std::vector<PlacedKeypoint> placed_;  ///< cell by cell, so that a row's cells are one run
};

}  // namespace posevote
