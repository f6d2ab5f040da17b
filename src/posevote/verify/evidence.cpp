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

/// Chance that one random descriptor comes as near. Below a tenth of the reference the power law is
/// not trusted any more.
double chance_of(float distance, const Reference& reference, const EvidenceOptions& options) {
  if (!(reference.distance > 0)) return 1;
  const double ratio = std::max(0.1F, distance / reference.distance);
  return std::min(1.0, reference.rate * std::pow(ratio, options.dimension));
}

/// What a view's key point must look like in the scene.
struct Expected {
  cv::Point2f place;
  float least_scale = 0, largest_scale = -1;  ///< none when the pose turns it inside out
  float cosine = 1, sine = 0;                 ///< of its angle
  std::int8_t laplacian = 0;
};

Expected predict(const cv::Matx33d& scene_from_view, const Keypoint& k, float stretch) {
  Expected expected;
  expected.place = transform_point(scene_from_view, {k.x, k.y});
  const cv::Matx22d jacobian = local_jacobian(scene_from_view, {k.x, k.y});
  const double determinant = cv::determinant(jacobian);
  if (!(determinant > 0)) return expected;
  const float scale = k.scale * static_cast<float>(std::sqrt(determinant));
  expected.least_scale = scale / stretch;
  expected.largest_scale = scale * stretch;
  const double dx = std::cos(k.angle), dy = std::sin(k.angle);
  const double x = jacobian(0, 0) * dx + jacobian(0, 1) * dy;
  const double y = jacobian(1, 0) * dx + jacobian(1, 1) * dy;
  const double length = std::max(1e-12, std::sqrt(x * x + y * y));
  expected.cosine = static_cast<float>(x / length);
  expected.sine = static_cast<float>(y / length);
  expected.laplacian = k.laplacian;
  return expected;
}

/// The limits of `EvidenceOptions`, made ready for the innermost loop.
struct Limits {
  explicit Limits(const EvidenceOptions& options)
      : stretch(static_cast<float>(std::exp2(options.max_scale_octaves))),
        cosine(static_cast<float>(std::cos(options.max_rotation_deg * std::numbers::pi / 180))) {}
  float stretch;  ///< largest factor between a scale and the expected one
  float cosine;   ///< least, of the angle between them
};

bool fits(const PlacedKeypoint& found, const Expected& expected, const Limits& limits) {
  return found.scale >= expected.least_scale && found.scale <= expected.largest_scale &&
         found.laplacian * expected.laplacian >= 0 &&
         found.cosine * expected.cosine + found.sine * expected.sine >= limits.cosine;
}

struct Trial {
  int count = 0;          ///< scene features of fitting place, scale and rotation
  Candidate best{{}, 1};  ///< chance 1: none that counts
};

Trial try_feature(const cv::Matx33d& scene_from_view, float tolerance_px, int view, int feature,
                  const SceneContext& scene, const std::vector<char>& taken, const Limits& limits,
                  const EvidenceOptions& options) {
  const Features& known = scene.models.views()[static_cast<std::size_t>(view)].view->features;
  const Features& found = scene.grid.features();
  Trial trial;
  const Expected expected =
      predict(scene_from_view, known.keypoints[static_cast<std::size_t>(feature)], limits.stretch);
  if (!(expected.largest_scale >= scene.grid.least_scale()) || std::isnan(expected.place.x))
    return trial;
  const float* taught = nullptr;  // read when it is needed: most places have nothing that fits
  scene.grid.for_each_near(expected.place, tolerance_px, [&](const PlacedKeypoint& k) {
    if (!fits(k, expected, limits)) return;
    const int s = k.index;
    if (!taken.empty() && taken[static_cast<std::size_t>(s)]) return;
    ++trial.count;
    const Reference reference = scene.neighborhood.reference(s, view, feature);
    if (!taught) taught = scene.rivals.taught_row(view, feature);
    const float distance = descriptor_distance(found.descriptors, s, taught);
    const float ratio = reference.distance > 0 ? distance / reference.distance : 2.F;
    if (ratio > static_cast<float>(options.max_ratio)) return;
    const double chance = chance_of(distance, reference, options);
    if (chance < trial.best.chance) trial.best = {{s, view, feature, distance, ratio}, chance};
  });
  if (trial.best.chance < 1) {
    const Reference rivals = scene.rivals.reference(view, feature);
    trial.best.chance =
        std::max(trial.best.chance, chance_of(trial.best.match.distance, rivals, options));
    trial.best.chance = std::min(1.0, trial.best.chance * trial.count);
  }
  return trial;
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
  list.add("tolerance", tolerance, {0, 1}, "",
           "Search radius about a feature's predicted place, in object sizes.");
  list.add("min_tolerance_px", min_tolerance_px, {0.1, 100}, "px", "Smallest search radius.");
  list.add("max_features", max_features, {10, 1000000}, "",
           "Features of a view that are looked for in the scene, strongest first.");
  list.add("rivals", rivals, {1, 1000}, "",
           "A view feature's match must stand out against the so-many-th nearest scene feature.");
  list.add("max_rotation_deg", max_rotation_deg, {1, 180}, "deg",
           "Largest difference of a match's rotation to the pose's.");
  list.add("max_scale_octaves", max_scale_octaves, {0.1, 10}, "",
           "Largest difference of a match's scale to the pose's, in doublings.");
}

float EvidenceOptions::tolerance_px(double object_size_px) const {
  return static_cast<float>(std::max(min_tolerance_px, tolerance * object_size_px));
}

Evidence gather_evidence(const cv::Matx33d& scene_from_view, float tolerance_px, int view,
                         const SceneContext& scene, const std::vector<char>& taken,
                         const EvidenceOptions& options) {
  const Features& known = scene.models.views()[static_cast<std::size_t>(view)].view->features;
  Evidence evidence;
  std::vector<Candidate> candidates;
  const Limits limits(options);
  const int count = std::min(options.max_features, static_cast<int>(known.size()));
  for (int i = 0; i < count; ++i) {
    const Trial trial =
        try_feature(scene_from_view, tolerance_px, view, i, scene, taken, limits, options);
    if (trial.count == 0) continue;
    ++evidence.trials;
    if (trial.best.chance < 1) candidates.push_back(trial.best);
  }
  std::vector<double> chances;
  for (const Candidate& candidate : distinct(std::move(candidates), scene.grid.features())) {
    evidence.inliers.push_back(candidate.match);
    chances.push_back(candidate.chance);
  }
  const ChanceResult chance = log10_chance(chances, evidence.trials);
  evidence.log10_chance = chance.log10_chance;
  evidence.decisive = chance.decisive;
  return evidence;
}

double log10_pose_count(cv::Size scene_size, double object_size_px, double tolerance_px) {
  // A pose parameter that moves the object's rim by one tolerance makes another pose.
  const double rim = std::max(1.0, 0.5 * object_size_px / tolerance_px);
  double poses = std::log10(std::max(1.0, scene_size.area() / (tolerance_px * tolerance_px)));
  poses += std::log10(2 * std::numbers::pi * rim);    // rotation
  poses += std::log10(std::numbers::ln2 * 6 * rim);   // scale, six doublings
  poses += 2 * std::log10(std::max(1.0, 0.5 * rim));  // stretch and shear to +-25 %
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
