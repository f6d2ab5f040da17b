// Homography and verification exactly as the paper has them (III.B.3 and III.B.4).
#pragma once

#include <vector>

#include "posevote/verify/verifier.hpp"

namespace posevote {

struct PaperOptions {
  double min_confidence = 0.15;  ///< Eq. 11
  int min_matches = 5;           ///< f_m
  double ransac_error_px = 3;
  void describe(OptionList& list);
};

/// For each object the RANSAC homography with most inliers over its bins, in descending order of
/// votes, until the next bin holds fewer matches than the best has inliers; one instance per
/// object. `rejected` is set when f_m or p = f_m / f_t are too small. `log10_false_alarms` is 0:
/// the paper knows none.
[[nodiscard]] std::vector<Hypothesis> apply_paper_rule(const std::vector<PoseCluster>& clusters,
                                                       const SceneContext& scene,
                                                       const PaperOptions& options);

}  // namespace posevote
