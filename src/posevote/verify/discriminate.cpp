#include "posevote/verify/discriminate.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "posevote/verify/transform.hpp"

namespace posevote {
namespace {

constexpr double kDiffers = 24;       // of 255, mean of the channels: more than light and noise do
constexpr double kLeastShare = 0.02;  // of the common area; less tells nothing

cv::Mat soft(const cv::Mat& bgr) {
  cv::Mat result;
  cv::GaussianBlur(bgr, result, {}, 1.5);
  result.convertTo(result, CV_32FC3);
  return result;
}

/// The picture with the scene's mean and spread of each channel over the mask.
cv::Mat in_light_of(const cv::Mat& scene, const cv::Mat& picture, const cv::Mat& mask) {
  cv::Scalar mean, spread, scene_mean, scene_spread;
  cv::meanStdDev(picture, mean, spread, mask);
  cv::meanStdDev(scene, scene_mean, scene_spread, mask);
  cv::Mat channels[3], result;
  cv::split(picture, channels);
  for (int c = 0; c < 3; ++c) {
    const double gain = std::clamp(scene_spread[c] / std::max(1.0, spread[c]), 0.25, 4.0);
    channels[c] = (channels[c] - mean[c]) * gain + scene_mean[c];
  }
  cv::merge(channels, 3, result);
  return result;
}

cv::Mat distance_of(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat difference, channels[3];
  cv::absdiff(a, b, difference);
  cv::split(difference, channels);
  return (channels[0] + channels[1] + channels[2]) / 3;
}

}  // namespace

double discriminate(const PlacedPatch& a, const PlacedPatch& b, const ScenePyramid& scene) {
  if (a.patch.empty() || b.patch.empty()) return 0;
  const cv::Size size = a.patch.pixels.size();
  const cv::Matx33d scene_from_a = a.scene_from_view * a.patch.view_from_patch();
  const cv::Matx33d b_from_a = (b.scene_from_view * b.patch.view_from_patch()).inv() * scene_from_a;
  const cv::Point2f middle = 0.5F * cv::Point2f(cv::Point(size));
  const double step = std::sqrt(std::abs(cv::determinant(local_jacobian(scene_from_a, middle))));
  cv::Mat seen, inside, other, other_mask;
  scene.warp(scene_from_a, step, size, seen, inside);
  const int flags = cv::INTER_LINEAR | cv::WARP_INVERSE_MAP;
  cv::warpPerspective(b.patch.pixels, other, b_from_a, size, flags, cv::BORDER_REPLICATE);
  cv::warpPerspective(b.patch.mask, other_mask, b_from_a, size, flags);
  const cv::Mat common = a.patch.mask & (other_mask > 250) & inside;
  if (cv::countNonZero(common) == 0) return 0;

  const cv::Mat target = soft(seen);
  const cv::Mat first = in_light_of(target, soft(a.patch.pixels), common);
  const cv::Mat second = in_light_of(target, soft(other), common);
  const cv::Mat differs = common & (distance_of(first, second) > kDiffers);
  if (cv::countNonZero(differs) < kLeastShare * cv::countNonZero(common)) return 0;
  const double from_first = cv::mean(distance_of(first, target), differs)[0];
  const double from_second = cv::mean(distance_of(second, target), differs)[0];
  return (from_second - from_first) / std::max(1e-9, from_first + from_second);
}

}  // namespace posevote
