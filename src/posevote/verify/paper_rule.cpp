#include "posevote/verify/paper_rule.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

/// RANSAC homography of one bin; no inliers when there is none.
Hypothesis fit_bin(const PoseCluster& cluster, const SceneContext& scene,
                   const PaperOptions& options) {
  Hypothesis result;
  result.view = cluster.view;
  const View& view = *scene.models.views()[static_cast<std::size_t>(cluster.view)].view;
  std::vector<cv::Point2f> from, to;
  for (const int m : cluster.matches) {
    const Match& match = scene.matches[static_cast<std::size_t>(m)];
    const Keypoint& v = view.features.keypoints[static_cast<std::size_t>(match.feature)];
    const Keypoint& s = scene.grid.features().keypoints[static_cast<std::size_t>(match.scene)];
    from.emplace_back(v.x, v.y);
    to.emplace_back(s.x, s.y);
  }
  if (from.size() < 4) return result;
  cv::Mat inliers;
  const cv::Mat h = cv::findHomography(from, to, cv::RANSAC, options.ransac_error_px, inliers);
  if (h.empty() || !cv::checkRange(h)) return result;
  result.scene_from_view = h;
  for (std::size_t i = 0; i < cluster.matches.size(); ++i)
    if (inliers.at<uchar>(static_cast<int>(i)))
      result.evidence.inliers.push_back(
          scene.matches[static_cast<std::size_t>(cluster.matches[i])]);
  return result;
}

void verify(Hypothesis& hypothesis, const SceneContext& scene, const PaperOptions& options) {
  const int matched = static_cast<int>(hypothesis.evidence.inliers.size());
  hypothesis.features_in_area =
      features_in_area(hypothesis.view, hypothesis.scene_from_view, scene);
  if (matched < options.min_matches)
    hypothesis.rejected = "only " + std::to_string(matched) + " features agree on a homography";
  else if (matched < options.min_confidence * hypothesis.features_in_area)
    hypothesis.rejected = "too small a share of the features in its area are matched";
}

}  // namespace

void PaperOptions::describe(OptionList& list) {
  list.add("min_confidence", min_confidence, {0, 1}, "",
           "Smallest share of matched features in the object's area (Eq. 11), preset 'paper'.");
  list.add("min_matches", min_matches, {4, 1000}, "", "Fewest matched features, preset 'paper'.");
  list.add("ransac_error_px", ransac_error_px, {0.1, 100}, "px",
           "Reprojection error of an inlier, preset 'paper'.");
}

std::vector<Hypothesis> apply_paper_rule(const std::vector<PoseCluster>& clusters,
                                         const SceneContext& scene, const PaperOptions& options) {
  std::vector<Hypothesis> best(scene.models.objects().size());
  std::vector<char> seen(best.size(), 0);
  for (const PoseCluster& cluster : clusters) {
    const auto object = static_cast<std::size_t>(
        scene.models.views()[static_cast<std::size_t>(cluster.view)].object);
    // Early termination: a bin cannot beat the best with fewer entries than that has inliers.
    if (cluster.matches.size() < best[object].evidence.inliers.size()) continue;
    Hypothesis candidate = fit_bin(cluster, scene, options);
    if (!seen[object] || candidate.evidence.inliers.size() > best[object].evidence.inliers.size())
      best[object] = std::move(candidate);
    seen[object] = 1;
  }
  std::vector<Hypothesis> result;
  for (std::size_t object = 0; object < best.size(); ++object) {
    if (!seen[object]) continue;
    verify(best[object], scene, options);
    result.push_back(std::move(best[object]));
  }
  return result;
}

}  // namespace posevote
