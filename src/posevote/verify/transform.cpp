#include "posevote/verify/transform.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

struct Centred {
  cv::Point2d view, scene;
};

Centred centroids(const std::vector<PointPair>& pairs) {
  Centred sum;
  for (const auto& pair : pairs) {
    sum.view += cv::Point2d(pair.view);
    sum.scene += cv::Point2d(pair.scene);
  }
  const double n = static_cast<double>(pairs.size());
  return {sum.view / n, sum.scene / n};
}

cv::Matx33d about(const cv::Matx22d& a, const Centred& centre) {
  const double tx = centre.scene.x - a(0, 0) * centre.view.x - a(0, 1) * centre.view.y;
  const double ty = centre.scene.y - a(1, 0) * centre.view.x - a(1, 1) * centre.view.y;
  return {a(0, 0), a(0, 1), tx, a(1, 0), a(1, 1), ty, 0, 0, 1};
}

cv::Matx33d fit_similarity(const std::vector<PointPair>& pairs) {
  const Centred centre = centroids(pairs);
  double dot = 0, cross = 0, spread = 0;
  for (const auto& pair : pairs) {
    const cv::Point2d v = cv::Point2d(pair.view) - centre.view;
    const cv::Point2d s = cv::Point2d(pair.scene) - centre.scene;
    dot += v.dot(s);
    cross += v.cross(s);
    spread += v.dot(v);
  }
  if (spread < 1e-9) return cv::Matx33d::zeros();
  const double a = dot / spread, b = cross / spread;
  return about({a, -b, b, a}, centre);
}

cv::Matx33d fit_affine(const std::vector<PointPair>& pairs) {
  const Centred centre = centroids(pairs);
  cv::Matx22d moment = cv::Matx22d::zeros(), mixed = cv::Matx22d::zeros();
  for (const auto& pair : pairs) {
    const cv::Point2d v = cv::Point2d(pair.view) - centre.view;
    const cv::Point2d s = cv::Point2d(pair.scene) - centre.scene;
    moment += cv::Matx22d(v.x * v.x, v.x * v.y, v.x * v.y, v.y * v.y);
    mixed += cv::Matx22d(s.x * v.x, s.x * v.y, s.y * v.x, s.y * v.y);
  }
  const double determinant = cv::determinant(moment);
  const double trace = moment(0, 0) + moment(1, 1);
  if (determinant < 1e-6 * trace * trace) return cv::Matx33d::zeros();  // nearly on one line
  return about(mixed * moment.inv(), centre);
}

cv::Matx33d fit_homography(const std::vector<PointPair>& pairs) {
  std::vector<cv::Point2f> view, scene;
  for (const auto& pair : pairs) {
    view.push_back(pair.view);
    scene.push_back(pair.scene);
  }
  const cv::Mat h = cv::findHomography(view, scene, 0);
  if (h.empty() || !cv::checkRange(h)) return cv::Matx33d::zeros();
  return h;
}

double area_scale(const cv::Matx33d& h, cv::Point2f point) {
  return cv::determinant(local_jacobian(h, point));
}

}  // namespace

int points_needed(TransformKind kind) noexcept {
  return 2 + static_cast<int>(kind);
}

cv::Matx33d fit_transform(TransformKind kind, const std::vector<PointPair>& pairs) {
  if (static_cast<int>(pairs.size()) < points_needed(kind)) return cv::Matx33d::zeros();
  switch (kind) {
    case TransformKind::similarity:
      return fit_similarity(pairs);
    case TransformKind::affine:
      return fit_affine(pairs);
    case TransformKind::homography:
      return fit_homography(pairs);
  }
  return cv::Matx33d::zeros();
}

cv::Point2f transform_point(const cv::Matx33d& h, cv::Point2f p) {
  const double w = h(2, 0) * p.x + h(2, 1) * p.y + h(2, 2);
  if (!(w > 1e-9)) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    return {nan, nan};
  }
  return {static_cast<float>((h(0, 0) * p.x + h(0, 1) * p.y + h(0, 2)) / w),
          static_cast<float>((h(1, 0) * p.x + h(1, 1) * p.y + h(1, 2)) / w)};
}

cv::Matx22d local_jacobian(const cv::Matx33d& h, cv::Point2f p) {
  const double w = h(2, 0) * p.x + h(2, 1) * p.y + h(2, 2);
  const double x = (h(0, 0) * p.x + h(0, 1) * p.y + h(0, 2)) / w;
  const double y = (h(1, 0) * p.x + h(1, 1) * p.y + h(1, 2)) / w;
  return {(h(0, 0) - x * h(2, 0)) / w, (h(0, 1) - x * h(2, 1)) / w, (h(1, 0) - y * h(2, 0)) / w,
          (h(1, 1) - y * h(2, 1)) / w};
}

std::vector<cv::Point2f> transform_polygon(const cv::Matx33d& scene_from_view,
                                           const std::vector<cv::Point2f>& polygon) {
  std::vector<cv::Point2f> result;
  result.reserve(polygon.size());
  for (const auto& corner : polygon) {
    result.push_back(transform_point(scene_from_view, corner));
    if (std::isnan(result.back().x)) return {};
  }
  return result;
}

void PlausibilityOptions::describe(OptionList& list) {
  list.add("max_anisotropy", max_anisotropy, {1, 100}, "",
           "Largest over smallest stretch of the view; 4 is a flat thing seen at 75 degrees.");
  list.add("max_perspective", max_perspective, {1, 1000}, "",
           "Largest over smallest area scale over the outline.");
  list.add("min_scale", min_scale, {0.001, 1}, "", "Smallest scene px per view px.");
  list.add("max_scale", max_scale, {1, 1000}, "", "Largest scene px per view px.");
}

std::string why_implausible(const cv::Matx33d& scene_from_view,
                            const std::vector<cv::Point2f>& outline,
                            const PlausibilityOptions& options) {
  if (!cv::checkRange(cv::Mat(scene_from_view)) || scene_from_view(2, 2) == 0)
    return "no transform fits";
  const auto projected = transform_polygon(scene_from_view, outline);
  if (projected.empty()) return "folded over";
  cv::Point2f centre;
  double smallest = std::numeric_limits<double>::max(), largest = 0;
  for (const auto& corner : outline) {
    const double scale = area_scale(scene_from_view, corner);
    if (!(scale > 0)) return "mirrored";
    smallest = std::min(smallest, scale);
    largest = std::max(largest, scale);
    centre += corner;
  }
  centre /= static_cast<float>(outline.size());
  if (largest > options.max_perspective * smallest) return "too strong perspective";
  const cv::Matx22d jacobian = local_jacobian(scene_from_view, centre);
  cv::Vec2d stretch;
  cv::SVD::compute(jacobian, stretch, cv::SVD::NO_UV);
  if (!(stretch[1] > 0) || stretch[0] > options.max_anisotropy * stretch[1]) return "too skewed";
  const double scale = std::sqrt(stretch[0] * stretch[1]);
  if (scale < options.min_scale) return "too small";
  if (scale > options.max_scale) return "too large";
  return "";
}

}  // namespace posevote
