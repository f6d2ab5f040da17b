// The pose of a view in the scene from pairs of points: as much of a homography as the evidence
// pays for.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "posevote/core/options.hpp"
#include "posevote/verify/transform.hpp"

namespace posevote {

struct PoseFitOptions {
  double stretch_prior = 0.15;      ///< standard deviation of stretch and shear about a similarity
  double perspective_prior = 0.05;  ///< of the relative change of scale from centre to rim
  void describe(OptionList& list);
};

/// The frame in which a view's points are expressed: its centre, and half its size as unit.
struct ViewFrame {
  cv::Point2f centre;    ///< px
  double half_size = 1;  ///< px, > 0
};

/// Most probable homography when points err by `noise_px` (standard deviation, scene px) and
/// departures from a similarity are normally distributed as in `options`: few or crowded points
/// give a similarity, more of them an affine transform, many and far apart ones a homography.
/// Linear least squares with the priors as ridge, iterated for the weights of the perspective.
/// (2,2) = 1 at the view's origin. All-zero for fewer than 2 pairs or pairs all on one point.
[[nodiscard]] cv::Matx33d fit_pose(const std::vector<PointPair>& pairs, const ViewFrame& frame,
                                   double noise_px, const PoseFitOptions& options);

}  // namespace posevote
