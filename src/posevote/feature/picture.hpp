// What every extractor does before and after the extraction itself.
#pragma once

#include <opencv2/core.hpp>

#include "posevote/feature/features.hpp"

namespace posevote {

/// Throws Error{invalid_argument} unless `mask` is empty or CV_8U, one channel, of the size of
/// `image`.
void check_mask(const cv::Mat& image, const cv::Mat& mask);

/// True where the pixel nearest to (x, y) is not 0 in `mask`, or `mask` is empty. The point may lie
/// up to half a pixel outside.
[[nodiscard]] bool is_inside_mask(const cv::Mat& mask, float x, float y);

/// The order of `Extractor::extract`: stronger first; equally strong ones by y, x, scale, angle.
[[nodiscard]] bool comes_before(const Keypoint& a, const Keypoint& b);

}  // namespace posevote
