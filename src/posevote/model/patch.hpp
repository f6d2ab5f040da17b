// A small picture of a taught view: what the whole object looks like, without its features.
#pragma once

#include <opencv2/core.hpp>

namespace posevote {

/// The object reduced to a fixed size. Its pixels outside the mask mean nothing.
struct Patch {
  cv::Mat pixels;      ///< CV_8UC3 BGR
  cv::Mat mask;        ///< CV_8U 0/255, size of `pixels`
  double scale = 1;    ///< px of the view per px of the patch
  cv::Point2d corner;  ///< px of the view at the centre of the patch's first pixel

  [[nodiscard]] bool empty() const { return pixels.empty(); }
  /// Maps px of the patch to px of the view.
  [[nodiscard]] cv::Matx33d view_from_patch() const {
    return {scale, 0, corner.x, 0, scale, corner.y, 0, 0, 1};
  }
};

/// `picture`: CV_8UC3; `mask`: CV_8U of its size, non-zero on the object. The object's area becomes
/// that of a square of 64 px; it is not enlarged. Empty for an empty mask.
[[nodiscard]] Patch make_patch(const cv::Mat& picture, const cv::Mat& mask);

/// The patch with half as many pixels each way.
[[nodiscard]] Patch half_of(const Patch& patch);

}  // namespace posevote
