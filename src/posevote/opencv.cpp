#include "posevote/opencv.hpp"

#include "posevote/core/error.hpp"
#include "posevote/feature/features.hpp"

#if POSEVOTE_WITH_SURF
#include <algorithm>
#include <cmath>

#include "posevote/feature/surf/surf.hpp"

namespace posevote {
namespace {

constexpr float kSizePerScale = 9 / 1.2F;  // the filter of size 9 stands for a scale of 1.2 px

float degrees_from_radians(float angle) {
  const auto degrees = static_cast<float>(angle * 180 / CV_PI);
  return degrees < 0 ? std::min(degrees + 360, 359.99997F) : degrees;
}

cv::KeyPoint to_opencv(const Keypoint& keypoint) {
  constexpr int kOctave = 0;  // of no use: the size says it
  return {keypoint.x,
          keypoint.y,
          keypoint.scale * kSizePerScale,
          degrees_from_radians(keypoint.angle),
          keypoint.response,
          kOctave,
          keypoint.laplacian};
}

// Points of any detector: wherever they are and however large, something can be described there.
Keypoint from_opencv(const cv::KeyPoint& point) {
  const auto bounded = [](float value, float least, float most) {
    return std::isfinite(value) ? std::clamp(value, least, most) : least;
  };
  Keypoint keypoint;
  keypoint.x = bounded(point.pt.x, -1e5F, 1e5F);
  keypoint.y = bounded(point.pt.y, -1e5F, 1e5F);
  keypoint.scale = bounded(point.size / kSizePerScale, 0.1F, 1e4F);
  return keypoint;
}

class OpenCvSurf final : public cv::Feature2D {
 public:
  explicit OpenCvSurf(const FeatureOptions& options) : options_(options) {}

  void detectAndCompute(cv::InputArray image, cv::InputArray mask,
                        std::vector<cv::KeyPoint>& keypoints, cv::OutputArray descriptors,
                        bool use_provided_keypoints) override {
    const cv::Mat picture = image.getMat();
    if (picture.empty()) {
      if (!use_provided_keypoints) keypoints.clear();
      if (descriptors.needed()) descriptors.release();
    } else if (use_provided_keypoints) {
      describe(picture, keypoints, descriptors);
    } else {
      find(picture, mask.getMat(), keypoints, descriptors);
    }
  }

  int descriptorSize() const override { return simd::kDescriptorSize; }
  int descriptorType() const override { return CV_32F; }
  int defaultNorm() const override { return cv::NORM_L2; }
  cv::String getDefaultName() const override { return "posevote.SURF"; }

 private:
  void find(const cv::Mat& picture, const cv::Mat& mask, std::vector<cv::KeyPoint>& keypoints,
            cv::OutputArray descriptors) {
    const Features features = workspace_.extract(picture, mask, options_, descriptors.needed());
    keypoints.clear();
    for (const Keypoint& keypoint : features.keypoints) keypoints.push_back(to_opencv(keypoint));
    if (descriptors.needed()) store(features.descriptors, descriptors);
  }

  void describe(const cv::Mat& picture, std::vector<cv::KeyPoint>& points,
                cv::OutputArray descriptors) {
    std::vector<Keypoint> keypoints;
    keypoints.reserve(points.size());
    for (const cv::KeyPoint& point : points) keypoints.push_back(from_opencv(point));
    const cv::Mat rows = workspace_.describe(picture, keypoints, options_);
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i].angle = degrees_from_radians(keypoints[i].angle);
    if (descriptors.needed()) store(rows, descriptors);
  }

  static void store(const cv::Mat& rows, cv::OutputArray descriptors) {
    if (rows.empty())
      descriptors.release();
    else
      rows.copyTo(descriptors);
  }

  FeatureOptions options_;
  surf::Workspace workspace_;
};

}  // namespace

cv::Ptr<cv::Feature2D> create_surf(double hessian_threshold, int max_features) {
  FeatureOptions options;
  options.surf.hessian_threshold = hessian_threshold;
  options.max_features = max_features;
  validate_options(options);
  return cv::makePtr<OpenCvSurf>(options);
}

}  // namespace posevote

#else

namespace posevote {

cv::Ptr<cv::Feature2D> create_surf(double, int) {
  throw Error(ErrorCode::unsupported,
              "this build of posevote has no SURF (POSEVOTE_WITH_SURF=OFF); use cv::SIFT");
}

}  // namespace posevote

#endif
