// What speaks for a pose: guided matches, and how many false alarms so much agreement would cost.
//
// A-contrario reasoning (Moisan & Stival 2004; Lowe 2001): under the hypothesis of chance the
// descriptors of the scene have nothing to do with the object. A view feature whose surroundings in
// the scene hold c features of fitting place, scale and rotation then finds one as near as distance
// d with probability
//
//     p = min(1, c * rate * (d / reference)^dimension),
//
// where `reference` is how near other objects' descriptors come to that scene feature, and `rate`
// is the chance of a single random one to do so (Reference). With n such trials and p_k the k-th
// smallest of their p, the expected number of poses in the whole search space that agree so well by
// accident is
//
//     NFA = N_views * N_poses * n * min_k C(n, k) * p_k^k.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "posevote/core/options.hpp"
#include "posevote/match/matcher.hpp"
#include "posevote/verify/scene_context.hpp"
#include "posevote/verify/transform.hpp"

namespace posevote {

struct EvidenceOptions {
  double dimension = 8;     ///< exponent of the distance law above
  double max_ratio = 1.0;   ///< guided matches: distance / reference distance
  double tolerance = 0.03;  ///< search radius about the predicted place, in object sizes
  double min_tolerance_px = 3;
  int max_features = 4000;         ///< of a view, strongest first, that are looked for
  int rivals = 8;                  ///< how many scene features may resemble a view feature
  double max_rotation_deg = 30;    ///< rotation of a match against that of the pose
  double max_scale_octaves = 0.7;  ///< scale of a match against that of the pose
  void describe(OptionList& list);

  /// Search radius in the scene for an object of that size (px).
  [[nodiscard]] float tolerance_px(double object_size_px) const;
};

/// The evidence for one pose of one view.
struct Evidence {
  std::vector<Match> inliers;  ///< one-to-one, on distinct spots, most convincing first
  int trials = 0;              ///< view features that had a candidate
  double log10_chance = 0;     ///< log10 of n * min_k C(n,k) p_k^k
  int decisive = 0;            ///< the k of that minimum
};

/// Guided matching: for every view feature the best scene feature of fitting place, scale and
/// rotation. `taken[s]` != 0 leaves scene feature s out (empty: none).
[[nodiscard]] Evidence gather_evidence(const cv::Matx33d& scene_from_view, float tolerance_px,
                                       int view, const SceneContext& scene,
                                       const std::vector<char>& taken,
                                       const EvidenceOptions& options);

/// log10 of the number of similarity and affine poses that can be told apart at this tolerance.
[[nodiscard]] double log10_pose_count(cv::Size scene_size, double object_size_px,
                                      double tolerance_px);

/// log10 of the binomial coefficient n over k.
[[nodiscard]] double log10_binomial(int n, int k);

/// log10 of n * min_k C(n,k) p_k^k over ascending probabilities in (0, 1]; n >= p.size() trials.
/// `decisive` is the minimising k. 0 and k = 0 without probabilities.
struct ChanceResult {
  double log10_chance = 0;
  int decisive = 0;
};
[[nodiscard]] ChanceResult log10_chance(const std::vector<double>& ascending, int trials);

}  // namespace posevote
