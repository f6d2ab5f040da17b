// The steps of SURF on one picture, with all buffers: what the extractor and OpenCV's interface
// share.
#pragma once

#include <chrono>
#include <opencv2/core.hpp>

#include "posevote/feature/features.hpp"
#include "posevote/feature/surf/descriptor.hpp"
#include "posevote/feature/surf/hessian.hpp"
#include "posevote/feature/surf/integral.hpp"

namespace posevote::surf {

/// Wall time of each step, ms.
struct StageTimes {
  double integral = 0, hessian = 0, selection = 0, orientation = 0, descriptor = 0;
};

/// Keeps its buffers from picture to picture; one thread at a time.
class Workspace {
 public:
  /// `image` and `mask` as in Extractor::extract. The result is the same for any number of threads.
  [[nodiscard]] Features extract(const cv::Mat& image, const cv::Mat& mask,
                                 const FeatureOptions& options, bool with_descriptors = true);
  /// Sets the angles (unless upright) and returns one descriptor per key point. `keypoints` may
  /// come from any detector; finite, scale > 0.
  [[nodiscard]] cv::Mat describe(const cv::Mat& image, std::vector<Keypoint>& keypoints,
                                 const FeatureOptions& options);
  /// Of the last call of `extract`.
  [[nodiscard]] const StageTimes& times() const noexcept { return times_; }

 private:
  void load(const cv::Mat& image, const FeatureOptions& options);
  [[nodiscard]] std::vector<Keypoint> find(const cv::Mat& mask, const FeatureOptions& options);
  [[nodiscard]] cv::Mat describe_all(std::vector<Keypoint>& keypoints,
                                     const FeatureOptions& options, bool with_descriptors);

  cv::Mat grey_;
  Integral integral_;
  BlobSearch search_;
  BoxSums boxes_;
  StageTimes times_;
};

}  // namespace posevote::surf
