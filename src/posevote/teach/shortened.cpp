#include "posevote/teach/shortened.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace posevote {

ShortenedPicture shorten(const cv::Mat& picture, const cv::Mat& mask, double fx, double fy) {
  const auto length = [](int side, double factor) { return std::max(1, cvRound(side * factor)); };
  const cv::Size size(length(picture.cols, fx), length(picture.rows, fy));
  ShortenedPicture copy;
  cv::resize(picture, copy.picture, size, 0, 0, cv::INTER_AREA);
  if (!mask.empty()) cv::resize(mask, copy.mask, size, 0, 0, cv::INTER_NEAREST);
  copy.fx = size.width / static_cast<double>(picture.cols);
  copy.fy = size.height / static_cast<double>(picture.rows);
  return copy;
}

Features lengthen(Features features, double fx, double fy) {
  for (Keypoint& k : features.keypoints) {
    k.x = static_cast<float>((k.x + 0.5) / fx - 0.5);
    k.y = static_cast<float>((k.y + 0.5) / fy - 0.5);
    k.scale = static_cast<float>(k.scale / std::sqrt(fx * fy));
    k.angle = static_cast<float>(std::atan2(std::sin(k.angle) / fy, std::cos(k.angle) / fx));
    if (k.angle >= std::numbers::pi_v<float>) k.angle = -std::numbers::pi_v<float>;
  }
  return features;
}

}  // namespace posevote
