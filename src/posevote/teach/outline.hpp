// The silhouette of a mask as a polygon.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace posevote {

/// A simple polygon of at least 3 points around the object pixels (non-zero) of `mask` (CV_8U), px:
/// the outer border of its one part, simplified to within `tolerance_px`, or the convex hull of all
/// parts when there are several, or when the border touches itself. Holes are not part of it.
/// Within half a pixel of the pixels' outer edges. Empty if the mask is.
[[nodiscard]] std::vector<cv::Point2f> outline_of(const cv::Mat& mask, double tolerance_px = 1);

/// Centroid of the object pixels of `mask`, px. Requires at least one.
[[nodiscard]] cv::Point2f centroid_of(const cv::Mat& mask);

/// True if no two sides of the closed polygon meet except neighbours in their common corner.
[[nodiscard]] bool is_simple(const std::vector<cv::Point2f>& polygon);

}  // namespace posevote
