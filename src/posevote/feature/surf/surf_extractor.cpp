#include "posevote/feature/surf/surf_extractor.hpp"

#include <algorithm>

#include "posevote/feature/picture.hpp"
#include "posevote/feature/surf/descriptor.hpp"
#include "posevote/feature/surf/hessian.hpp"
#include "posevote/feature/surf/orientation.hpp"

namespace posevote {
namespace {

class SurfExtractor final : public Extractor {
 public:
  explicit SurfExtractor(const FeatureOptions& options) : options_(options) {}

  Features extract(const cv::Mat& image, const cv::Mat& mask) const override {
    check_mask(image, mask);
    const cv::Mat grey = to_grey(image);
    if (grey.empty()) return {};
    surf::Integral integral;
    integral.compute(grey);

    Features features;
    features.keypoints = surf::find_blobs(integral, options_.surf);
    std::erase_if(features.keypoints,
                  [&](const Keypoint& point) { return !is_inside_mask(mask, point.x, point.y); });
    std::ranges::sort(features.keypoints, comes_before);
    const auto limit = static_cast<std::size_t>(options_.max_features);
    if (limit > 0 && features.size() > limit) features.keypoints.resize(limit);
    if (features.empty()) return features;

    features.descriptors.create(static_cast<int>(features.size()), surf::kDescriptorSize, CV_32F);
    for (std::size_t i = 0; i < features.size(); ++i) {
      Keypoint& point = features.keypoints[i];
      if (!options_.surf.upright) point.angle = surf::orientation(integral, point);
      surf::describe(integral, point, features.descriptors.ptr<float>(static_cast<int>(i)));
    }
    return features;
  }

 private:
  FeatureOptions options_;
};

}  // namespace

std::shared_ptr<const Extractor> make_surf_extractor(const FeatureOptions& options) {
  return std::make_shared<SurfExtractor>(options);
}

}  // namespace posevote
