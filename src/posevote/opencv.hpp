// posevote's SURF for programs that use OpenCV's feature interface.
#pragma once

#include <opencv2/features2d.hpp>

namespace posevote {

/// A drop-in for cv::xfeatures2d::SURF (64 numbers, CV_32F, NORM_L2, rows of length 1): detect,
/// compute and detectAndCompute, also on key points of other detectors, whose angles are then set.
/// `hessian_threshold` is on OpenCV's scale for 8-bit pictures; `max_features`: keep the strongest,
/// 0 for all. Key points as in OpenCV's: `size` is the side of the filter in px (7.5 times the
/// scale), `angle` in degrees [0, 360) clockwise as seen, `class_id` the sign of the Laplacian (1
/// dark, -1 bright), strongest first. Pictures: 8- or 16-bit, 1, 3 or 4 channels; an empty one has
/// no key points.
///
/// Unlike OpenCV's, key points near the border are described too, and none is ever removed by
/// compute(). Descriptors may not be mixed with OpenCV's. The object may be used by one thread at a
/// time. Throws Error{invalid_argument} for values out of range, other pictures and wrong masks,
/// Error{unsupported} in a build without SURF.
[[nodiscard]] cv::Ptr<cv::Feature2D> create_surf(double hessian_threshold = 100,
                                                 int max_features = 0);

}  // namespace posevote
