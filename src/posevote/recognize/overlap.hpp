// Overlap of two boxes.
#pragma once

#include <opencv2/core.hpp>

namespace posevote {

/// Intersection over union; 0 for two empty boxes.
[[nodiscard]] inline double overlap(const cv::Rect2f& a, const cv::Rect2f& b) {
  const double common = (a & b).area();
  const double all = a.area() + b.area() - common;
  return all > 0 ? common / all : 0;
}

}  // namespace posevote
