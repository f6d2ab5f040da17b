#include "logic/relief.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace posevote::logic {
namespace {

constexpr double least_turn_deg = 5, most_turn_deg = 60;
constexpr int most_features = 600;         // of a view: the strongest
constexpr double most_ratio = 0.9;         // distances of the nearest and the next
constexpr std::size_t least_matches = 12;  // of a pair, that agree
constexpr double least_share = 0.4;        // of a pair's matches, that agree
constexpr double tolerance = 0.04;   // of the epipolar lines, in units of the object's half size
constexpr int trials = 40;           // per tilt
constexpr double smoothness = 0.5;   // weight of a flat relief, in matches
constexpr double most_hollow = 0.2;  // coefficient of x^2, negated
constexpr double noise = 0.03;       // of a depth: beyond, a match counts less and less

/// A feature in two views, px from their centres in units of the object's half size.
struct Correspondence {
  cv::Point2d here, there;
};

struct SurfacePoint {
  cv::Point2d place;
  double depth = 0;
};

struct PairRelief {
  double tilt_deg = 0;
  std::vector<SurfacePoint> points;  ///< depths up to a constant
};

double half_size(const View& view) {
  const cv::Rect box = cv::boundingRect(view.outline);
  return std::max({box.width, box.height, 1}) / 2.0;
}

double turn_between(const View& from, const View& to) {
  return std::remainder(to.yaw_deg - from.yaw_deg, 360.0);
}

std::array<double, 5> terms(cv::Point2d p) {
  return {p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y};
}

/// The nearest and its distance, and whether the next one is much farther.
struct Nearest {
  int index = -1;
  bool clear = false;
};

std::vector<Nearest> nearest_of_rows(const cv::Mat& similarity) {
  std::vector<Nearest> found(static_cast<std::size_t>(similarity.rows));
  for (int i = 0; i < similarity.rows; ++i) {
    const float* row = similarity.ptr<float>(i);
    float best = -2, next = -2;
    for (int j = 0; j < similarity.cols; ++j)
      if (row[j] > best) {
        next = best;
        best = row[j];
        found[static_cast<std::size_t>(i)].index = j;
      } else {
        next = std::max(next, row[j]);
      }
    // Descriptors have length 1: squared distance = 2 - 2 similarity.
    found[static_cast<std::size_t>(i)].clear = 1 - best < most_ratio * most_ratio * (1 - next);
  }
  return found;
}

std::vector<Correspondence> match_views(const View& here, const View& there) {
  const auto strongest = [](const Features& features) {
    return features.descriptors.rowRange(0, std::min(features.descriptors.rows, most_features));
  };
  if (here.features.size() < 2 || there.features.size() < 2) return {};
  const cv::Mat similarity = strongest(here.features) * strongest(there.features).t();
  const auto forward = nearest_of_rows(similarity), back = nearest_of_rows(similarity.t());
  const double size = half_size(here);
  const auto place = [size](const View& view, int index) {
    const Keypoint& point = view.features.keypoints[static_cast<std::size_t>(index)];
    return (cv::Point2d(point.x, point.y) - cv::Point2d(view.centre)) / size;
  };
  std::vector<Correspondence> matches;
  for (int i = 0; i < similarity.rows; ++i) {
    const Nearest& nearest = forward[static_cast<std::size_t>(i)];
    if (nearest.clear && back[static_cast<std::size_t>(nearest.index)].index == i)
      matches.push_back({place(here, i), place(there, nearest.index)});
  }
  return matches;
}

/// Turn of the object by `turn_deg`, anticlockwise from above, as a camera sees it that looks down
/// by `tilt_deg`.
cv::Matx33d turned(double turn_deg, double tilt_deg) {
  const double tilt = tilt_deg * CV_PI / 180;
  cv::Matx33d rotation;
  cv::Rodrigues(cv::Vec3d(0, -std::cos(tilt), -std::sin(tilt)) * (turn_deg * CV_PI / 180),
                rotation);
  return rotation;
}

/// Where a point of depth z comes to lie: `scale` (A here + z d + shift). Across `d` the depth has
/// no say.
struct PairModel {
  cv::Matx22d flat;
  cv::Point2d along, across;  ///< `along`: d, not of length 1; `across`: of length 1
  PairModel(double turn_deg, double tilt_deg) {
    const cv::Matx33d r = turned(turn_deg, tilt_deg);
    flat = {r(0, 0), r(0, 1), r(1, 0), r(1, 1)};
    along = {r(0, 2), r(1, 2)};
    across = cv::Point2d(-along.y, along.x) / cv::norm(along);
  }
  [[nodiscard]] cv::Point2d moved(cv::Point2d p) const {
    return {flat(0, 0) * p.x + flat(0, 1) * p.y, flat(1, 0) * p.x + flat(1, 1) * p.y};
  }
};

/// The tilt, scale and shift across the lines that most matches agree with.
struct Agreement {
  double cost = 0, tilt_deg = 0, scale = 1, shift = 0;
};

Agreement find_agreement(const std::vector<Correspondence>& matches, double turn_deg) {
  Agreement best;
  best.cost = static_cast<double>(matches.size());
  cv::RNG random(1);
  std::vector<cv::Point2d> lines(matches.size());
  for (int step = -2; step <= 12; ++step) {
    const double tilt_deg = 5 * step;
    const PairModel model(turn_deg, tilt_deg);
    std::transform(matches.begin(), matches.end(), lines.begin(), [&](const Correspondence& m) {
      return cv::Point2d(model.across.dot(model.moved(m.here)), model.across.dot(m.there));
    });
    for (int trial = 0; trial < trials; ++trial) {
      const cv::Point2d& a = lines[random(static_cast<unsigned>(lines.size()))];
      const cv::Point2d& b = lines[random(static_cast<unsigned>(lines.size()))];
      const double scale = (b.y - a.y) / (b.x - a.x);
      if (std::abs(b.x - a.x) < 0.4 || !(scale > 0.8 && scale < 1.25)) continue;
      const double shift = a.y - scale * a.x;
      double cost = 0;
      for (const cv::Point2d& line : lines) {
        const double error = (line.y - scale * line.x - shift) / tolerance;
        cost += std::min(error * error, 1.0);
      }
      if (cost < best.cost) best = {cost, tilt_deg, scale, shift};
    }
  }
  return best;
}

std::optional<PairRelief> relief_of_pair(const View& here, const View& there) {
  const double turn_deg = turn_between(here, there);
  const auto matches = match_views(here, there);
  if (matches.size() < least_matches) return std::nullopt;
  const Agreement agreed = find_agreement(matches, turn_deg);
  const PairModel model(turn_deg, agreed.tilt_deg);
  PairRelief relief;
  relief.tilt_deg = agreed.tilt_deg;
  for (const Correspondence& m : matches) {
    const cv::Point2d moved = model.moved(m.here);
    const double error =
        model.across.dot(m.there) - agreed.scale * model.across.dot(moved) - agreed.shift;
    if (std::abs(error) > tolerance) continue;
    const double depth =
        model.along.dot(m.there / agreed.scale - moved) / model.along.dot(model.along);
    relief.points.push_back({m.here, depth});
  }
  const auto agreeing = static_cast<double>(relief.points.size());
  if (relief.points.size() < least_matches ||
      agreeing < least_share * static_cast<double>(matches.size()))
    return std::nullopt;

  // No surface reaches further than the object is large.
  auto& points = relief.points;
  auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
  std::nth_element(points.begin(), middle, points.end(),
                   [](const auto& a, const auto& b) { return a.depth < b.depth; });
  const double median = middle->depth;
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const auto& p) { return std::abs(p.depth - median) > 2; }),
               points.end());
  return relief;
}

/// Least squares, less and less of what does not fit; each pair has a constant of its own.
cv::Vec<double, 5> fit_surface(const std::vector<PairRelief>& pairs) {
  int rows = 0;
  for (const PairRelief& pair : pairs) rows += static_cast<int>(pair.points.size());
  const int unknowns = 5 + static_cast<int>(pairs.size());
  cv::Mat_<double> design(rows, unknowns, 0.0), depths(rows, 1);
  for (int row = 0, i = 0; i < static_cast<int>(pairs.size()); ++i)
    for (const SurfacePoint& point : pairs[static_cast<std::size_t>(i)].points) {
      const auto values = terms(point.place);
      std::copy(values.begin(), values.end(), design[row]);
      design(row, 5 + i) = 1;
      depths(row++) = point.depth;
    }
  cv::Mat_<double> stiffness(unknowns, unknowns, 0.0);
  for (int i = 0; i < unknowns; ++i) stiffness(i, i) = i < 5 ? smoothness : 1e-6;
  cv::Mat_<double> weights(rows, 1, 1.0), solution;
  for (int iteration = 0; iteration < 15; ++iteration) {
    cv::Mat_<double> weighted = design.clone();
    for (int row = 0; row < rows; ++row) weighted.row(row) *= weights(row);
    cv::solve(weighted.t() * design + stiffness, weighted.t() * depths, solution,
              cv::DECOMP_CHOLESKY);
    const cv::Mat_<double> errors(depths - design * solution);
    for (int row = 0; row < rows; ++row)
      weights(row) = noise / std::max(std::abs(errors(row)), noise);
  }
  return cv::Vec<double, 5>(solution.ptr<double>());
}

}  // namespace

double Relief::depth_px(cv::Point2d point) const {
  const auto values = terms((point - centre) / size_px);
  double depth = 0;
  for (int i = 0; i < 5; ++i) depth += shape[i] * values[static_cast<std::size_t>(i)];
  return depth * size_px;
}

Relief find_relief(const View& view, const std::vector<std::shared_ptr<const View>>& views) {
  Relief relief;
  relief.centre = view.centre;
  relief.size_px = half_size(view);
  std::vector<PairRelief> pairs;
  double matches = 0;
  for (const auto& other : views) {
    const double turn = std::abs(turn_between(view, *other));
    if (!(turn >= least_turn_deg && turn <= most_turn_deg)) continue;  // not for NaN
    auto pair = relief_of_pair(view, *other);
    if (!pair) continue;
    const auto count = static_cast<double>(pair->points.size());
    relief.tilt_deg += pair->tilt_deg * count;
    matches += count;
    pairs.push_back(std::move(*pair));
  }
  if (pairs.empty()) return relief;
  relief.tilt_deg /= matches;
  relief.shape = fit_surface(pairs);
  relief.known = relief.shape[2] >= -most_hollow;
  return relief;
}

Relief ReliefCache::find(const ObjectModel& object, const View& view) {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> hashes;
  for (const auto& one : object.views) hashes.push_back(one->hash);
  Known& known = known_[object.name];
  if (known.hashes != hashes) known = {hashes, {}};
  const auto found = known.reliefs.find(view.id);
  if (found != known.reliefs.end()) return found->second;
  return known.reliefs[view.id] = find_relief(view, object.views);
}

}  // namespace posevote::logic
