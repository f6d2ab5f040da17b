#include "posevote/verify/verifier.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

const View& view_of(const SceneContext& scene, int view) {
  return *scene.models.views()[static_cast<std::size_t>(view)].view;
}

PointPair points_of(const SceneContext& scene, const Match& match) {
  const Keypoint& v =
      view_of(scene, match.view).features.keypoints[static_cast<std::size_t>(match.feature)];
  const Keypoint& s = scene.grid.features().keypoints[static_cast<std::size_t>(match.scene)];
  return {{v.x, v.y}, {s.x, s.y}};
}

std::vector<PointPair> points_of(const SceneContext& scene, const std::vector<Match>& matches) {
  std::vector<PointPair> pairs;
  pairs.reserve(matches.size());
  for (const Match& match : matches) pairs.push_back(points_of(scene, match));
  return pairs;
}

double view_size(const View& view) {
  return std::sqrt(std::max(1.0, cv::boundingRect(view.outline).area() * 1.0));
}

/// Size of the object in the scene, px.
double scene_size_of(const View& view, const cv::Matx33d& scene_from_view) {
  const double scale = std::abs(cv::determinant(local_jacobian(scene_from_view, view.centre)));
  return view_size(view) * std::sqrt(scale);
}

/// The cluster's matches, each scene feature and each view feature once, best ratio first.
std::vector<Match> one_to_one(const PoseCluster& cluster, const std::vector<Match>& matches) {
  std::vector<Match> sorted;
  for (const int m : cluster.matches) sorted.push_back(matches[static_cast<std::size_t>(m)]);
  std::ranges::stable_sort(sorted, {}, &Match::ratio);
  std::vector<Match> kept;
  for (const Match& match : sorted)
    if (std::ranges::none_of(kept, [&](const Match& other) {
          return other.scene == match.scene || other.feature == match.feature;
        }))
      kept.push_back(match);
  return kept;
}

/// Sum of truncated squared errors (MSAC, Torr & Zisserman 2000); smaller is better.
double msac_cost(const cv::Matx33d& transform, const std::vector<PointPair>& pairs, double limit) {
  double cost = 0;
  for (const auto& pair : pairs) {
    const cv::Point2f error = transform_point(transform, pair.view) - pair.scene;
    cost += std::min(limit * limit, static_cast<double>(error.dot(error)));
  }
  return cost;
}

/// Two pairs make the proposal; without two more that agree nothing speaks for it.
constexpr int kMinAgreeing = 4;

int count_agreeing(const cv::Matx33d& transform, const std::vector<PointPair>& pairs,
                   double limit) {
  return static_cast<int>(std::ranges::count_if(pairs, [&](const PointPair& pair) {
    return cv::norm(transform_point(transform, pair.view) - pair.scene) <= limit;
  }));
}

/// The pose through two of the pairs on which most of the others agree: a similarity, of the view
/// or of the view as it looks from 45 degrees above or below. The pairs come best first, so trying
/// all couples of the first few is a deterministic PROSAC (Chum & Matas 2005).
cv::Matx33d propose_pose(const std::vector<PointPair>& pairs, double object_size,
                         const EvidenceOptions& options) {
  constexpr std::size_t kFirst = 24;
  const double limit = 2 * options.tolerance_px(object_size);
  cv::Matx33d best = cv::Matx33d::zeros();
  double best_cost = limit * limit * static_cast<double>(pairs.size());
  const std::size_t count = std::min(pairs.size(), kFirst);
  for (const double height : {1.0, 1 / std::numbers::sqrt2}) {
    const auto shortening = cv::Matx33d::diag({1, height, 1});
    std::vector<PointPair> seen = pairs;
    for (PointPair& pair : seen) pair.view.y *= static_cast<float>(height);
    for (std::size_t i = 0; i + 1 < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j) {
        if (cv::norm(seen[i].scene - seen[j].scene) < 2 * limit) continue;
        const auto candidate = fit_transform(TransformKind::similarity, {seen[i], seen[j]});
        const double cost = msac_cost(candidate, seen, limit);
        if (cost >= best_cost) continue;
        best = candidate * shortening;
        best_cost = cost;
      }
  }
  return best;
}

/// Share of the view's features inside the hull of the matched ones, of those that the picture
/// could show. A logo that another thing carries too covers little of the object.
double coverage_of(const std::vector<cv::Point2f>& matched, const Hypothesis& hypothesis,
                   const SceneContext& scene) {
  const View& view = view_of(scene, hypothesis.view);
  if (matched.size() < 3) return 0;
  std::vector<cv::Point2f> hull;
  cv::convexHull(matched, hull);
  const cv::Rect2f frame({0, 0}, cv::Size2f(scene.grid.size()));
  int visible = 0, covered = 0;
  for (const Keypoint& k : view.features.keypoints) {
    if (!frame.contains(transform_point(hypothesis.scene_from_view, {k.x, k.y}))) continue;
    ++visible;
    covered += cv::pointPolygonTest(hull, {k.x, k.y}, false) >= 0;
  }
  return visible > 0 ? static_cast<double>(covered) / visible : 0;
}

/// Evidence of a given pose, with its number of false alarms.
Hypothesis judge(int view, const cv::Matx33d& transform, const SceneContext& scene,
                 const std::vector<char>& taken, const VerifyOptions& options, double widen = 1) {
  Hypothesis result;
  result.view = view;
  result.scene_from_view = transform;
  const double size = scene_size_of(view_of(scene, view), transform);
  result.tolerance_px = static_cast<float>(widen) * options.evidence.tolerance_px(size);
  result.evidence =
      gather_evidence(transform, result.tolerance_px, view, scene, taken, options.evidence);
  result.log10_false_alarms = result.evidence.log10_chance +
                              std::log10(static_cast<double>(scene.models.views().size())) +
                              log10_pose_count(scene.grid.size(), size, result.tolerance_px);
  return result;
}

/// Fits a pose and gathers evidence in turn, from a wide to the final tolerance; ends with the
/// best.
Hypothesis refine(const Hypothesis& start, const SceneContext& scene,
                  const VerifyOptions& options) {
  const View& view = view_of(scene, start.view);
  const ViewFrame frame{view.centre, 0.5 * view_size(view)};
  Hypothesis best = start, current = start;
  for (const double widen : {1.5, 1.0, 1.0}) {
    const auto transform = fit_pose(points_of(scene, current.evidence.inliers), frame,
                                    0.5 * current.tolerance_px, options.pose);
    if (!why_implausible(transform, view.outline, options.plausibility).empty()) break;
    current = judge(start.view, transform, scene, {}, options, widen);
    if (widen == 1.0 && current.log10_false_alarms < best.log10_false_alarms) best = current;
  }
  return best;
}

/// Log of the largest over the smallest stretch at the view's centre.
double distortion_of(const Hypothesis& hypothesis, const View& view) {
  cv::Vec2d stretch;
  cv::SVD::compute(local_jacobian(hypothesis.scene_from_view, view.centre), stretch,
                   cv::SVD::NO_UV);
  return std::log(stretch[0] / std::max(1e-9, stretch[1]));
}

PresenceEvidence measure(const Hypothesis& hypothesis, const SceneContext& scene) {
  const View& view = view_of(scene, hypothesis.view);
  std::vector<cv::Point2f> matched;
  for (const Match& match : hypothesis.evidence.inliers)
    matched.push_back(points_of(scene, match).view);
  PresenceEvidence measured;
  measured.digits = -hypothesis.log10_false_alarms;
  measured.confidence = static_cast<double>(matched.size()) /
                        std::max(hypothesis.features_in_area, static_cast<int>(matched.size()));
  measured.coverage = coverage_of(matched, hypothesis, scene);
  measured.distortion = distortion_of(hypothesis, view);
  measured.found = static_cast<double>(matched.size()) / std::max(1, hypothesis.evidence.trials);
  measured.agreement =
      measure_agreement(view.patch, hypothesis.scene_from_view, matched, scene.pyramid);
  return measured;
}

/// Everything but the last word, which `rate` has.
void decide(Hypothesis& hypothesis, const SceneContext& scene, const VerifyOptions& options) {
  if (!hypothesis.rejected.empty()) return;
  const int inliers = static_cast<int>(hypothesis.evidence.inliers.size());
  if (inliers < options.min_inliers) {
    hypothesis.rejected = "only " + std::to_string(inliers) + " features agree on a pose";
    return;
  }
  hypothesis.stage = HypothesisStage::chance;
  if (hypothesis.log10_false_alarms > 0) {
    hypothesis.rejected = "so much agreement happens by chance";
    return;
  }
  hypothesis.features_in_area =
      features_in_area(hypothesis.view, hypothesis.scene_from_view, scene);
  hypothesis.measured = measure(hypothesis, scene);
  hypothesis.stage = HypothesisStage::presence;
}

}  // namespace

void VerifyOptions::describe(OptionList& list) {
  list.add("false_alarms_per_1000_images", false_alarms_per_1000_images, {1e-3, 1e6}, "",
           "The dial: how many false detections in 1000 pictures are acceptable.");
  list.add("min_inliers", min_inliers, {3, 1000}, "", "Fewest features that make a detection.");
  list.group("evidence", evidence);
  list.group("pose", pose);
  list.group("plausibility", plausibility);
}

int features_in_area(int view, const cv::Matx33d& scene_from_view, const SceneContext& scene) {
  const auto outline = transform_polygon(scene_from_view, view_of(scene, view).outline);
  return outline.empty() ? 0 : scene.grid.count_in(cv::Rect2d(cv::boundingRect(outline)));
}

Hypothesis verify_cluster(const PoseCluster& cluster, const SceneContext& scene,
                          const VerifyOptions& options) {
  Hypothesis best;
  best.view = cluster.view;
  const View& view = view_of(scene, cluster.view);
  const auto pairs = points_of(scene, one_to_one(cluster, scene.matches));
  const double expected_size = view_size(view) * cluster.pose.scale;
  const auto proposal = propose_pose(pairs, expected_size, options.evidence);
  best.rejected = why_implausible(proposal, view.outline, options.plausibility);
  if (!best.rejected.empty()) return best;

  if (count_agreeing(proposal, pairs, 2 * options.evidence.tolerance_px(expected_size)) <
      kMinAgreeing) {
    best.rejected = "the votes agree on no pose";
    return best;
  }

  // A glance at the strongest features tells most accidents from objects.
  constexpr int kGlance = 800;
  VerifyOptions glance = options;
  glance.evidence.max_features = std::min(kGlance, options.evidence.max_features);
  best = judge(cluster.view, proposal, scene, {}, glance, 1.5);
  // Refinement gains a few matches, not dozens: what is far from the goal now is given up.
  constexpr double kHopeless = 6;
  if (best.log10_false_alarms > kHopeless) {
    best.stage = HypothesisStage::chance;
    best.rejected = "so much agreement happens by chance";
    return best;
  }
  best = refine(best, scene, options);
  decide(best, scene, options);
  return best;
}

void rate(Hypothesis& hypothesis, const VerifyOptions& options) {
  if (!hypothesis.rejected.empty()) return;
  hypothesis.presence = rate_presence(hypothesis.measured);
  if (hypothesis.presence.probability() >=
      least_probability(options.false_alarms_per_1000_images)) {
    hypothesis.stage = HypothesisStage::accepted;
    return;
  }
  hypothesis.rejected = hypothesis.presence.object_log_odds < hypothesis.presence.place_log_odds
                            ? "a part of it agrees, but the rest looks like another thing"
                            : "it may be there, but too little agrees to say where";
}

void reconsider(Hypothesis& hypothesis, const SceneContext& scene, const std::vector<char>& taken,
                const VerifyOptions& options) {
  const double consensus = hypothesis.measured.consensus;
  hypothesis = judge(hypothesis.view, hypothesis.scene_from_view, scene, taken, options);
  decide(hypothesis, scene, options);
  hypothesis.measured.consensus = consensus;
  rate(hypothesis, options);
}

}  // namespace posevote
