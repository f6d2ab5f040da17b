// From a cluster of votes to a verified pose, or the reason why not.
#pragma once

#include <string>
#include <vector>

#include "posevote/verify/evidence.hpp"
#include "posevote/verify/pose_fit.hpp"
#include "posevote/verify/presence.hpp"
#include "posevote/verify/transform.hpp"
#include "posevote/vote/hough.hpp"

namespace posevote {

struct VerifyOptions {
  double false_alarms_per_1000_images = 15;  ///< the dial
  int min_inliers = 5;
  EvidenceOptions evidence;
  PoseFitOptions pose;
  PlausibilityOptions plausibility;
  void describe(OptionList& list);
};

/// How far a hypothesis came: the test that it did not pass.
enum class HypothesisStage {
  pose,      ///< its votes agree on no plausible pose
  chance,    ///< so much agreement happens by chance
  presence,  ///< it is not probable enough
  accepted   ///< it passed all; another may explain the same part of the picture better
};

/// A pose of a view with its evidence.
struct Hypothesis {
  int view = 0;  ///< index into ModelSet::views()
  cv::Matx33d scene_from_view;
  float tolerance_px = 0;
  Evidence evidence;
  int features_in_area = 0;       ///< f_t of Eq. 11
  double log10_false_alarms = 0;  ///< per image, with the number of poses and views tried
  PresenceEvidence measured;
  Presence presence;
  std::vector<int> alternatives;  ///< other objects that the scene cannot tell from it
  HypothesisStage stage = HypothesisStage::pose;
  std::string rejected;  ///< "" or why the cluster is no object: plain words
};

/// Finds the pose on which most of the cluster agrees, extends it by guided matching, refines it as
/// a similarity, affine transform or homography, whichever leaves the fewest false alarms.
/// Deterministic. `rejected` is set when no plausible pose was found or it could be chance; else
/// the hypothesis waits at the stage `presence` for `rate`.
[[nodiscard]] Hypothesis verify_cluster(const PoseCluster& cluster, const SceneContext& scene,
                                        const VerifyOptions& options);

/// Gives the probability of what was measured, and accepts the hypothesis or says why not.
void rate(Hypothesis& hypothesis, const VerifyOptions& options);

/// f_t of Eq. 11: scene features in the bounding box of the projected outline.
[[nodiscard]] int features_in_area(int view, const cv::Matx33d& scene_from_view,
                                   const SceneContext& scene);

/// Looks at the evidence of a pose again without the scene features in `taken`.
void reconsider(Hypothesis& hypothesis, const SceneContext& scene, const std::vector<char>& taken,
                const VerifyOptions& options);

}  // namespace posevote
