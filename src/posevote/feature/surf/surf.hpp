// The steps of SURF on one picture, with all buffers: what the extractor and OpenCV's interface
// share.
#pragma once

#include <chrono>
#include <opencv2/core.hpp>

#include "posevote/feature/features.hpp"
#include "posevote/feature/surf/descriptor.hpp"
#include "posevote/feature/surf/hessian.hpp"
#include "posevote/feature/surf/integral.hpp"
#include "posevote/feature/surf/select.hpp"
#include "posevote/feature/surf/team.hpp"

namespace posevote::surf {

/// Wall time of each step, ms. `hessian` ends with the peaks of each pair
/// of layers, `suppression` with the key points' places and scales.
struct StageTimes {
  double integral = 0, hessian = 0, suppression = 0, orientation = 0, descriptor = 0;
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
  const std::vector<Keypoint>& find(const cv::Mat& mask, const FeatureOptions& options);
  void sort_by_place(const std::vector<Keypoint>& keypoints);
  [[nodiscard]] cv::Mat describe_all(std::vector<Keypoint>& keypoints,
                                     const FeatureOptions& options, bool with_descriptors);

  cv::Mat grey_, doubled_, mask_;
  Team team_;
  Integral integral_;
  BlobSearch search_;
  Selector selector_;
  std::vector<int> order_, tile_ends_;  // of the key points; see sort_by_place
  std::vector<float> angles_;
  StageTimes times_;
};

}  // namespace posevote::surf
