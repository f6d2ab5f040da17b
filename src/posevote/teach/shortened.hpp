// A flat thing seen from aside: its picture, shortened.
#pragma once

#include <opencv2/core.hpp>

#include "posevote/feature/features.hpp"

namespace posevote {

/// What is left of a length that is seen from 45 degrees aside.
constexpr double kFromAside = 0.70710678118654752;  // 1 / sqrt(2)

/// A copy of a picture and its mask, whose sides are `fx` and `fy` times as long.
struct ShortenedPicture {
  cv::Mat picture, mask;
  double fx = 1, fy = 1;
};

/// `fx` and `fy` are met as nearly as whole pixels allow. `mask` may be empty.
[[nodiscard]] ShortenedPicture shorten(const cv::Mat& picture, const cv::Mat& mask, double fx,
                                       double fy);

/// The same features in the frame of the picture that was shortened: places, directions, and
/// scales by the area. What a scene shows from aside matches these descriptors, and the pose that
/// explains the matches is that of the picture itself.
[[nodiscard]] Features lengthen(Features features, double fx, double fy);

}  // namespace posevote
