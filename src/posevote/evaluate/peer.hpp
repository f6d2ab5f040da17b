// What people write today: OpenCV's features, a ratio test and RANSAC, for comparison.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posevote/evaluate/evaluator.hpp"
#include "posevote/evaluate/method.hpp"
#include "posevote/evaluate/report.hpp"

namespace posevote {

/// "opencv-sift" and "opencv-orb".
[[nodiscard]] const std::vector<std::string>& peer_names();

/// The usual script: key points of every taught view inside its silhouette; for each view the two
/// nearest scene descriptors, ratio test (0.75), homography by RANSAC (5 px), accepted with at
/// least 10 inliers. Of an object's views the one with most inliers counts, so an object is found
/// at most once; its silhouette is projected. `confidence` is inliers / matches. Exhaustive search.
class Peer {
 public:
  /// Views must have their pictures. Throws Error{invalid_argument} for an unknown name.
  Peer(const std::string& name, const ModelSet& models, int jobs = 0);
  ~Peer();

  /// Safe to call from many threads; deterministic.
  [[nodiscard]] RecognitionResult recognize(const cv::Mat& picture) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The peers on the same pictures, beside the evaluation: a row for each.
[[nodiscard]] ReportSection compare_peers(const std::vector<std::string>& names,
                                          const Evaluation& ours, const TaughtDataset& taught,
                                          const Method& method);

}  // namespace posevote
