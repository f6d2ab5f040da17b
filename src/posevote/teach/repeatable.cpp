#include "posevote/teach/repeatable.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

constexpr double kShort = 1 / std::numbers::sqrt2;  // of a length seen 45 degrees from the side

// `image` with its sides multiplied by fx and fy.
cv::Mat shortened(const cv::Mat& image, double fx, double fy, int interpolation) {
  if (image.empty()) return {};
  cv::Mat result;
  cv::resize(image, result, cv::Size(), fx, fy, interpolation);
  return result;
}

bool same_spot(const Keypoint& expected, const Keypoint& found) {
  constexpr double kHalfOctave = 0.5, kPrecision = 2;  // px, beside the key point's own scale
  return expected.laplacian == found.laplacian &&
         std::abs(std::log2(found.scale / expected.scale)) < kHalfOctave &&
         std::hypot(found.x - expected.x, found.y - expected.y) < kPrecision + expected.scale;
}

void mark_found(const Features& features, const Features& simulated, double fx, double fy,
                std::vector<char>& repeats) {
  if (simulated.empty()) return;
  cv::Mat distance, nearest;
  cv::batchDistance(features.descriptors, simulated.descriptors, distance, CV_32F, nearest,
                    cv::NORM_L2, 1);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Keypoint& k = features.keypoints[i];
    Keypoint expected = k;
    expected.x = static_cast<float>((k.x + 0.5) * fx - 0.5);
    expected.y = static_cast<float>((k.y + 0.5) * fy - 0.5);
    expected.scale = static_cast<float>(k.scale * std::sqrt(fx * fy));
    const int best = nearest.at<int>(static_cast<int>(i));
    if (same_spot(expected, simulated.keypoints[static_cast<std::size_t>(best)])) repeats[i] = 1;
  }
}

}  // namespace

std::vector<char> find_repeatable(const cv::Mat& picture, const cv::Mat& mask,
                                  const Features& features, const Extractor& extractor) {
  std::vector<char> repeats(features.size(), 0);
  if (features.empty()) return repeats;
  constexpr double kShortenings[][2] = {{kShort, 1}, {1, kShort}, {kShort, kShort}};
  for (const auto& [fx, fy] : kShortenings) {
    const Features simulated = extractor.extract(shortened(picture, fx, fy, cv::INTER_AREA),
                                                 shortened(mask, fx, fy, cv::INTER_NEAREST));
    const double exact_fx = cvRound(picture.cols * fx) / static_cast<double>(picture.cols);
    const double exact_fy = cvRound(picture.rows * fy) / static_cast<double>(picture.rows);
    mark_found(features, simulated, exact_fx, exact_fy, repeats);
  }
  return repeats;
}

}  // namespace posevote
