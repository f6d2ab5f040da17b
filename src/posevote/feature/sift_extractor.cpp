#include "posevote/feature/sift_extractor.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/features2d.hpp>

#include "posevote/feature/picture.hpp"

namespace posevote {
namespace {

// OpenCV 4.6 enlarges the picture by two with pixel centres at (x + 0.5) / 2 - 0.5, but halves the
// coordinates of what it finds there.
constexpr float kDoublingShift = 0.25F;

Keypoint keypoint_from_opencv(const cv::KeyPoint& point) {
  Keypoint keypoint;
  keypoint.x = point.pt.x - kDoublingShift;
  keypoint.y = point.pt.y - kDoublingShift;
  keypoint.scale = point.size / 2;
  const double turn = point.angle / 360.0;
  keypoint.angle = static_cast<float>((turn - std::floor(turn + 0.5)) * 2 * CV_PI);
  keypoint.response = point.response;
  return keypoint;
}

void make_root_sift(cv::Mat row) {
  const double sum = cv::norm(row, cv::NORM_L1);
  if (sum > 0) cv::sqrt(row / sum, row);
}

class SiftExtractor final : public Extractor {
 public:
  explicit SiftExtractor(const FeatureOptions& options) : options_(options) {}

  Features extract(const cv::Mat& image, const cv::Mat& mask) const override {
    check_mask(image, mask);
    const cv::Mat grey = to_grey(image);
    if (grey.empty()) return {};
    std::vector<cv::KeyPoint> points;
    cv::Mat descriptors;
    const SiftOptions& sift = options_.sift;
    cv::SIFT::create(0, sift.layers, sift.contrast_threshold, sift.edge_threshold, sift.sigma)
        ->detectAndCompute(grey, mask, points, descriptors);
    return strongest(points, descriptors);
  }

 private:
  Features strongest(const std::vector<cv::KeyPoint>& points, const cv::Mat& descriptors) const {
    std::vector<Keypoint> keypoints;
    keypoints.reserve(points.size());
    for (const auto& point : points) keypoints.push_back(keypoint_from_opencv(point));
    std::vector<int> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order,
                      [&](int a, int b) { return comes_before(keypoints[a], keypoints[b]); });
    const auto limit = static_cast<std::size_t>(options_.max_features);
    if (limit > 0 && order.size() > limit) order.resize(limit);

    Features features;
    if (order.empty()) return features;
    features.descriptors.create(static_cast<int>(order.size()), descriptors.cols, CV_32F);
    for (const int from : order) {
      const cv::Mat row = features.descriptors.row(static_cast<int>(features.keypoints.size()));
      descriptors.row(from).copyTo(row);
      make_root_sift(row);
      features.keypoints.push_back(keypoints[from]);
    }
    return features;
  }

  FeatureOptions options_;
};

}  // namespace

std::shared_ptr<const Extractor> make_sift_extractor(const FeatureOptions& options) {
  return std::make_shared<SiftExtractor>(options);
}

}  // namespace posevote
