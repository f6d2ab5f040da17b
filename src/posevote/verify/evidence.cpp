#include "posevote/verify/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace posevote {
namespace {

struct Candidate {
  Match match;
  double chance;
};

float descriptor_distance(const cv::Mat& a, int row_a, const cv::Mat& b, int row_b) {
  const float* pa = a.ptr<float>(row_a);
  const float* pb = b.ptr<float>(row_b);
  float sum = 0;
  for (int i = 0; i < a.cols; ++i) sum += (pa[i] - pb[i]) * (pa[i] - pb[i]);
  return std::sqrt(sum);
}

float angle_between(float a, float b) {
  return std::abs(std::remainder(a - b, 2 * std::numbers::pi_v<float>));
}

/// What a view's key point must look like in the scene.
Keypoint predict(const cv::Matx33d& scene_from_view, const Keypoint& k) {
  Keypoint expected = k;
  const cv::Point2f place = transform_point(scene_from_view, {k.x, k.y});
  const cv::Matx22d jacobian = local_jacobian(scene_from_view, {k.x, k.y});
  const double determinant = cv::determinant(jacobian);
  const double dx = std::cos(k.angle), dy = std::sin(k.angle);
  expected.x = place.x;
  expected.y = place.y;
  expected.scale = determinant > 0 ? k.scale * static_cast<float>(std::sqrt(determinant)) : -1;
  expected.angle = static_cast<float>(std::atan2(jacobian(1, 0) * dx + jacobian(1, 1) * dy,
                                                 jacobian(0, 0) * dx + jacobian(0, 1) * dy));
  return expected;
}

bool fits(const Keypoint& found, const Keypoint& expected, const EvidenceOptions& options) {
  if (found.laplacian * expected.laplacian < 0) return false;
  const auto octaves = static_cast<float>(options.max_scale_octaves);
  if (std::abs(std::log2(found.scale / expected.scale)) > octaves) return false;
  return angle_between(found.angle, expected.angle) <=
         static_cast<float>(options.max_rotation_deg) * std::numbers::pi_v<float> / 180;
}

/// Keeps the most convincing candidates such that no scene feature serves twice and no two lie on
/// one spot: a blob found in two octaves, or by two views' features, is one observation.
std::vector<Candidate> distinct(std::vector<Candidate> candidates, const Features& scene) {
  std::ranges::stable_sort(candidates, {}, &Candidate::chance);
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates) {
    const Keypoint& k = scene.keypoints[static_cast<std::size_t>(candidate.match.scene)];
    const bool free = std::ranges::none_of(kept, [&](const Candidate& other) {
      const Keypoint& o = scene.keypoints[static_cast<std::size_t>(other.match.scene)];
      const float near = std::max(1.5F, 0.5F * std::min(k.scale, o.scale));
      return std::abs(k.x - o.x) < near && std::abs(k.y - o.y) < near;
    });
    if (free) kept.push_back(candidate);
  }
  return kept;
}

}  // namespace

void EvidenceOptions::describe(OptionList& list) {
  list.add("dimension", dimension, {1, 128}, "",
           "How fast chance matches get rarer with smaller descriptor distance: the exponent.");
  list.add("max_ratio", max_ratio, {0.1, 3}, "",
           "Largest distance of a guided match, as a share of the reference distance.");
  list.add("similarity_tolerance", similarity_tolerance, {0, 1}, "",
           "Search radius about the predicted place, in object sizes, similarity transforms.");
  list.add("affine_tolerance", affine_tolerance, {0, 1}, "", "The same for affine transforms.");
  list.add("homography_tolerance", homography_tolerance, {0, 1}, "", "The same for homographies.");
  list.add("min_tolerance_px", min_tolerance_px, {0.1, 100}, "px", "Smallest search radius.");
  list.add("max_rotation_deg", max_rotation_deg, {1, 180}, "deg",
           "Largest difference of a match's rotation to the pose's.");
  list.add("max_scale_octaves", max_scale_octaves, {0.1, 10}, "",
           "Largest difference of a match's scale to the pose's, in doublings.");
}

float EvidenceOptions::tolerance_px(TransformKind kind, double object_size_px) const {
  const double share = kind == TransformKind::similarity ? similarity_tolerance
                       : kind == TransformKind::affine   ? affine_tolerance
                                                         : homography_tolerance;
  return static_cast<float>(std::max(min_tolerance_px, share * object_size_px));
}

Evidence gather_evidence(const cv::Matx33d& scene_from_view, float tolerance_px, int view,
                         const ModelSet& models, const SceneGrid& grid,
                         const Neighborhood& neighborhood, const std::vector<char>& taken,
                         const EvidenceOptions& options) {
  const auto& entry = models.views()[static_cast<std::size_t>(view)];
  const Features& known = entry.view->features;
  const Features& scene = grid.features();
  Evidence evidence;
  std::vector<Candidate> candidates;
  for (int i = 0; i < static_cast<int>(known.size()); ++i) {
    const Keypoint expected =
        predict(scene_from_view, known.keypoints[static_cast<std::size_t>(i)]);
    if (!(expected.scale > 0) || std::isnan(expected.x)) continue;
    int count = 0;
    Candidate best{{}, 2};
    grid.for_each_near({expected.x, expected.y}, tolerance_px, [&](int s) {
      if (!taken.empty() && taken[static_cast<std::size_t>(s)]) return;
      if (!fits(scene.keypoints[static_cast<std::size_t>(s)], expected, options)) return;
      ++count;
      const Reference reference = neighborhood.reference(s, entry.object);
      const float distance = descriptor_distance(scene.descriptors, s, known.descriptors, i);
      const float ratio = reference.distance > 0 ? distance / reference.distance : 2.F;
      const double chance = reference.rate * std::pow(std::max(ratio, 0.1F), options.dimension);
      if (chance < best.chance) best = {{s, view, i, distance, ratio}, chance};
    });
    if (count == 0) continue;
    ++evidence.trials;
    best.chance = std::min(1.0, best.chance * count);
    if (best.match.ratio <= static_cast<float>(options.max_ratio) && best.chance < 1)
      candidates.push_back(best);
  }
  std::vector<double> chances;
  for (const Candidate& candidate : distinct(std::move(candidates), scene)) {
    evidence.inliers.push_back(candidate.match);
    chances.push_back(candidate.chance);
  }
  const ChanceResult chance = log10_chance(chances, evidence.trials);
  evidence.log10_chance = chance.log10_chance;
  evidence.decisive = chance.decisive;
  return evidence;
}

double log10_pose_count(TransformKind kind, cv::Size scene_size, double object_size_px,
                        double tolerance_px) {
  // A pose parameter that moves the object's rim by one tolerance makes another pose.
  const double rim = std::max(1.0, 0.5 * object_size_px / tolerance_px);
  double poses = std::log10(std::max(1.0, scene_size.area() / (tolerance_px * tolerance_px)));
  poses += std::log10(2 * std::numbers::pi * rim);   // rotation
  poses += std::log10(std::numbers::ln2 * 6 * rim);  // scale, six doublings
  if (kind != TransformKind::similarity)
    poses += 2 * std::log10(rim);  // stretch and shear to +-50 %
  if (kind == TransformKind::homography) poses += 2 * std::log10(std::max(1.0, 0.5 * rim));
  return poses;
}

double log10_binomial(int n, int k) {
  return (std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0)) /
         std::numbers::ln10;
}

ChanceResult log10_chance(const std::vector<double>& ascending, int trials) {
  ChanceResult best;
  const double log_trials = std::log10(std::max(1, trials));
  for (int k = 1; k <= static_cast<int>(ascending.size()); ++k) {
    const double value = log_trials + log10_binomial(std::max(trials, k), k) +
                         k * std::log10(ascending[static_cast<std::size_t>(k - 1)]);
    if (value < best.log10_chance) best = {value, k};
  }
  return best;
}

}  // namespace posevote
