#include "posevote/teach/repeatable.hpp"

#include <cmath>
#include <limits>

#include "posevote/teach/shortened.hpp"

namespace posevote {
namespace {

bool same_spot(const Keypoint& expected, const Keypoint& found) {
  constexpr double kHalfOctave = 0.5, kPrecision = 2;  // px, beside the key point's own scale
  return expected.laplacian == found.laplacian &&
         std::abs(std::log2(found.scale / expected.scale)) < kHalfOctave &&
         std::hypot(found.x - expected.x, found.y - expected.y) <= kPrecision + expected.scale;
}

}  // namespace

ShortenedFeatures extract_shortened(const cv::Mat& picture, const cv::Mat& mask, double fx,
                                    double fy, const Extractor& extractor) {
  const ShortenedPicture copy = shorten(picture, mask, fx, fy);
  return {extractor.extract(copy.picture, copy.mask), copy.fx, copy.fy};
}

std::vector<float> find_likenesses(const Features& features, const ShortenedFeatures& shortened) {
  std::vector<float> found(features.size(), std::numeric_limits<float>::infinity());
  if (features.empty() || shortened.features.empty()) return found;
  const double fx = shortened.fx, fy = shortened.fy;
  cv::Mat rows, distance, nearest;
  features.descriptors.convertTo(rows, CV_32F);  // of a loaded view they are half floats
  cv::batchDistance(rows, shortened.features.descriptors, distance, CV_32F, nearest, cv::NORM_L2,
                    1);
  for (std::size_t i = 0; i < features.size(); ++i) {
    Keypoint expected = features.keypoints[i];
    expected.x = static_cast<float>((expected.x + 0.5) * fx - 0.5);
    expected.y = static_cast<float>((expected.y + 0.5) * fy - 0.5);
    expected.scale = static_cast<float>(expected.scale * std::sqrt(fx * fy));
    const int row = static_cast<int>(i), best = nearest.at<int>(row);
    if (same_spot(expected, shortened.features.keypoints[static_cast<std::size_t>(best)]))
      found[i] = distance.at<float>(row);
  }
  return found;
}

std::vector<char> find_repeatable(const cv::Mat& picture, const cv::Mat& mask,
                                  const Features& features, const Extractor& extractor) {
  std::vector<char> repeats(features.size(), 0);
  if (features.empty()) return repeats;
  constexpr double kShortenings[][2] = {{kFromAside, 1}, {1, kFromAside}, {kFromAside, kFromAside}};
  for (const auto& [fx, fy] : kShortenings) {
    const auto found =
        find_likenesses(features, extract_shortened(picture, mask, fx, fy, extractor));
    for (std::size_t i = 0; i < found.size(); ++i)
      if (std::isfinite(found[i])) repeats[i] = 1;
  }
  return repeats;
}

}  // namespace posevote
