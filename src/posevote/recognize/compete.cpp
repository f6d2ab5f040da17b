#include "posevote/recognize/compete.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "posevote/recognize/overlap.hpp"
#include "posevote/verify/discriminate.hpp"

namespace posevote {
namespace {

/// The part of the scene in which an object was surely seen: the convex hull of its matches.
class Region {
 public:
  Region(const Hypothesis& hypothesis, const Features& scene) {
    for (const Match& match : hypothesis.evidence.inliers) {
      const Keypoint& k = scene.keypoints[static_cast<std::size_t>(match.scene)];
      points_.emplace_back(k.x, k.y);
    }
    cv::convexHull(points_, hull_);
    reach_ = hypothesis.tolerance_px;
    const auto reach = static_cast<float>(reach_);
    surroundings_ = cv::boundingRect(hull_);
    surroundings_ += cv::Size2f(2 * reach, 2 * reach);
    surroundings_ -= cv::Point2f(reach, reach);
  }

  [[nodiscard]] bool contains(cv::Point2f point) const {
    return surroundings_.contains(point) && cv::pointPolygonTest(hull_, point, true) >= -reach_;
  }
  /// Share of this region's own matches that lie in the other.
  [[nodiscard]] double share_in(const Region& other) const {
    const auto inside = std::ranges::count_if(
        points_, [&](const cv::Point2f& point) { return other.contains(point); });
    return static_cast<double>(inside) / static_cast<double>(points_.size());
  }
  [[nodiscard]] cv::Point2f centre() const {
    const cv::Rect2f box = cv::boundingRect(hull_);
    return 0.5F * (box.tl() + box.br());
  }
  [[nodiscard]] double area() const { return std::max(1.0, cv::contourArea(hull_)); }

 private:
  std::vector<cv::Point2f> points_, hull_;
  double reach_ = 0;
  cv::Rect2f surroundings_;  ///< contains whatever the region contains
};

/// A hypothesis that was kept, with what it claims of the scene.
struct Claim {
  Claim(Hypothesis h, const SceneContext& scene)
      : hypothesis(std::move(h)), region(hypothesis, scene.grid.features()) {
    const auto& entry = scene.models.views()[static_cast<std::size_t>(hypothesis.view)];
    object = entry.object;
    box = cv::boundingRect(transform_polygon(hypothesis.scene_from_view, entry.view->outline));
  }

  Hypothesis hypothesis;
  Region region;
  int object = 0;
  cv::Rect2f box;
};

/// `front` hides a part of `back` when the latter has hardly a match where it should have many.
bool stands_in_front(const Region& front, const Region& back) {
  const double expected = std::min(1.0, front.area() / back.area()) * front.share_in(back);
  return back.share_in(front) < 0.25 * expected;
}

/// Share of a claim's matched scene features that look like one of the other claim's: a second copy
/// of an object shows what the first shows.
double resemblance(const Claim& claim, const Claim& other, const SceneContext& scene) {
  const cv::Mat& descriptors = scene.grid.features().descriptors;
  const auto& own = claim.hypothesis.evidence.inliers;
  const auto alike = std::ranges::count_if(own, [&](const Match& match) {
    const float limit =
        scene.neighborhood.reference(match.scene, match.view, match.feature).distance;
    return std::ranges::any_of(other.hypothesis.evidence.inliers, [&](const Match& candidate) {
      return descriptor_distance(descriptors, match.scene,
                                 descriptors.ptr<float>(candidate.scene)) < limit;
    });
  });
  return static_cast<double>(alike) / static_cast<double>(own.size());
}

/// Another side of the same thing: near the better claim, but showing other features. Two copies of
/// one object side by side show the same ones.
bool is_other_side(const Claim& claim, const Claim& better, const SceneContext& scene) {
  if (claim.object != better.object) return false;
  const cv::Point2f between = claim.region.centre() - better.region.centre();
  const float reach = std::max(better.box.width, better.box.height);
  constexpr double kCopy = 0.25;  // of the features; copies share most, sides next to none
  return cv::norm(between) < reach && resemblance(claim, better, scene) < kCopy;
}

/// No two things are in one place.
bool is_excluded(const Claim& claim, const std::vector<Claim>& better, const SceneContext& scene,
                 double max_overlap) {
  return std::ranges::any_of(better, [&](const Claim& other) {
    if (is_other_side(claim, other, scene)) return true;
    if (overlap(other.box, claim.box) <= max_overlap) return false;
    return other.object == claim.object || !stands_in_front(claim.region, other.region);
  });
}

/// Scene features that are explained by better claims, as flags.
std::vector<char> features_taken(const Claim& claim, const std::vector<Claim>& better,
                                 const Features& scene) {
  std::vector<char> taken(scene.size(), 0);
  for (const Claim& other : better) {
    if (stands_in_front(claim.region, other.region)) continue;
    for (std::size_t s = 0; s < scene.size(); ++s)
      if (other.region.contains({scene.keypoints[s].x, scene.keypoints[s].y})) taken[s] = 1;
  }
  return taken;
}

/// Several views of an object explain the same features. The features say which object it is;
/// where it is they say together: of those with a good part of the strongest one's evidence, the
/// one that is most probably in its place, and whose box overlaps most with what the others claim,
/// goes first. A view that was found twice there speaks once. `claims` are sorted, best first.
void prefer_best_placed(std::vector<Claim>& claims) {
  constexpr double kPart = 0.6;  // of the strongest one's digits
  const auto probability = [](const Claim& claim) {
    return claim.hypothesis.presence.probability();
  };
  for (auto first = claims.begin(); first != claims.end(); ++first) {
    std::vector<std::size_t> same;
    for (auto other = first; other != claims.end(); ++other) {
      if (other->hypothesis.log10_false_alarms > kPart * first->hypothesis.log10_false_alarms)
        break;
      if (other->object == first->object && other->region.share_in(first->region) >= 0.5)
        same.push_back(static_cast<std::size_t>(other - claims.begin()));
    }
    const auto placement = [&](std::size_t one) {
      std::map<int, double> overlap_of;  // by view
      for (const std::size_t other : same) {
        double& most = overlap_of[claims[other].hypothesis.view];
        most = std::max(most,
                        probability(claims[other]) * overlap(claims[one].box, claims[other].box));
      }
      double sum = 0;
      for (const auto& [view, most] : overlap_of) sum += most;
      return probability(claims[one]) * sum;
    };
    if (same.empty()) continue;
    const auto best =
        claims.begin() + static_cast<std::ptrdiff_t>(std::ranges::max(same, {}, placement));
    std::rotate(first, best, best + 1);
  }
}

/// Two objects that look alike are both found in one place. The one that is much more probably the
/// thing there - colour, structure and all that was measured - is reported; of two that are equally
/// probable the parts in which they differ decide, if they are clear. Otherwise both names are
/// reported.
void settle(Claim& better, const Claim& claim, const SceneContext& scene) {
  const double kMuchMore = std::log(5.0);  // right decisions of the development sets: 1.8 and more
  constexpr double kClear = 0.1;           // right decisions of the development sets: 0.14 and more
  const auto placed = [&](const Claim& of) {
    const auto& entry = scene.models.views()[static_cast<std::size_t>(of.hypothesis.view)];
    return PlacedPatch{entry.view->patch, of.hypothesis.scene_from_view};
  };
  const double surer =
      better.hypothesis.presence.object_log_odds - claim.hypothesis.presence.object_log_odds;
  const double for_better = std::abs(surer) >= kMuchMore
                                ? surer
                                : discriminate(placed(better), placed(claim), scene.pyramid);
  if (for_better < -kClear) {
    better = claim;
  } else if (for_better < kClear) {
    auto& names = better.hypothesis.alternatives;
    if (!std::ranges::count(names, claim.object)) names.push_back(claim.object);
  }
}

/// The claim of another object in the same place, to which `claim` comes near in evidence: the
/// features that they share speak for both.
Claim* look_alike(const Claim& claim, std::vector<Claim>& better, double max_overlap) {
  constexpr double kNear = 0.5;  // of the better one's digits
  const auto found = std::ranges::find_if(better, [&](const Claim& other) {
    return other.object != claim.object && overlap(other.box, claim.box) > max_overlap &&
           claim.hypothesis.log10_false_alarms < kNear * other.hypothesis.log10_false_alarms &&
           !stands_in_front(claim.region, other.region);
  });
  return found == better.end() ? nullptr : &*found;
}

}  // namespace

std::vector<Hypothesis> compete(std::vector<Hypothesis> hypotheses, const SceneContext& scene,
                                const RecognizeOptions& options) {
  std::erase_if(hypotheses, [](const Hypothesis& h) { return !h.rejected.empty(); });
  std::ranges::stable_sort(hypotheses, {}, &Hypothesis::log10_false_alarms);
  std::vector<Claim> candidates, claims;
  for (Hypothesis& hypothesis : hypotheses) candidates.emplace_back(std::move(hypothesis), scene);
  prefer_best_placed(candidates);
  for (Claim& claim : candidates) {
    if (Claim* other = look_alike(claim, claims, options.max_overlap)) {
      settle(*other, claim, scene);
      continue;
    }
    if (is_excluded(claim, claims, scene, options.max_overlap)) continue;
    const std::vector<char> taken = features_taken(claim, claims, scene.grid.features());
    const bool contested = std::ranges::any_of(
        claim.hypothesis.evidence.inliers,
        [&](const Match& match) { return taken[static_cast<std::size_t>(match.scene)] != 0; });
    if (contested) reconsider(claim.hypothesis, scene, taken, options.verify);
    if (claim.hypothesis.rejected.empty()) claims.push_back(std::move(claim));
  }
  std::vector<Hypothesis> kept;
  kept.reserve(claims.size());
  for (Claim& claim : claims) kept.push_back(std::move(claim.hypothesis));
  return kept;
}

}  // namespace posevote
