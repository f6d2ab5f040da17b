#include "posevote/verify/agreement.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "posevote/verify/transform.hpp"

namespace posevote {
namespace {

constexpr int kMostLevels = 8;
constexpr int kLeastSide = 24;  // px; of the smallest level
constexpr double kStep = 1.6;   // px of a level per px of the patch, at most

cv::Mat to_bgr8(const cv::Mat& image) {
  if (image.empty()) return image;
  cv::Mat eight = image, bgr;
  if (image.depth() == CV_16U) image.convertTo(eight, CV_8U, 1.0 / 256);
  if (eight.channels() == 3) return eight;
  cv::cvtColor(eight, bgr, eight.channels() == 1 ? cv::COLOR_GRAY2BGR : cv::COLOR_BGRA2BGR);
  return bgr;
}

cv::Mat grey_of(const cv::Mat& bgr) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  cv::GaussianBlur(grey, grey, {}, 0.7);
  return grey;
}

struct Gradient {
  explicit Gradient(const cv::Mat& bgr) {
    const cv::Mat grey = grey_of(bgr);
    cv::Sobel(grey, x, CV_32F, 1, 0);
    cv::Sobel(grey, y, CV_32F, 0, 1);
  }
  cv::Mat x, y;
};

/// Of Sobel's kernel in 8-bit grey values: below it there is no edge, and what is below it in the
/// scene has no direction.
constexpr float kEdge = 20, kFlat = 100;

struct Mean {
  double sum = 0;
  int count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  [[nodiscard]] double value() const { return count > 0 ? sum / count : 0; }
};

void compare_structure(const Gradient& a, const Gradient& b, const cv::Mat& mask,
                       const cv::Mat& near_matches, Agreement& result) {
  Mean all, matched;
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x) {
      if (!mask.at<uchar>(y, x)) continue;
      const float ax = a.x.at<float>(y, x), ay = a.y.at<float>(y, x);
      const float size_a = std::hypot(ax, ay);
      if (size_a < kEdge) continue;
      const float bx = b.x.at<float>(y, x), by = b.y.at<float>(y, x);
      const double cosine = (ax * bx + ay * by) / (size_a * std::hypot(bx, by) + kFlat);
      all.add(cosine);
      if (near_matches.at<uchar>(y, x)) matched.add(cosine);
    }
  result.structure = all.value();
  result.structure_near_matches = matched.value();
}

/// Px of the patch along the rim's outer normal: about what a good pose is wrong by.
constexpr int kRimFrom = -3, kRimTo = 2;

/// Median of right detections, for rim outside the picture.
constexpr double kUsualRim = 0.55;

/// Where its silhouette ends, an object stands out against what is behind it. `inside`: as of
/// `ScenePyramid::warp`.
double rim_of(const Gradient& scene, const cv::Mat& silhouette, const cv::Mat& inside) {
  cv::Mat inner, seen, soft, normal_x, normal_y;
  const cv::Mat cross = cv::getStructuringElement(cv::MORPH_CROSS, {3, 3});
  cv::erode(silhouette, inner, cross);
  cv::erode(inside, seen, cross);
  const cv::Mat whole = silhouette & ~inner, rim = whole & seen;
  silhouette.convertTo(soft, CV_32F, -1);
  cv::GaussianBlur(soft, soft, {}, 1);
  cv::Sobel(soft, normal_x, CV_32F, 1, 0);
  cv::Sobel(soft, normal_y, CV_32F, 0, 1);
  const cv::Rect all({}, silhouette.size());
  std::vector<cv::Point> places;
  cv::findNonZero(rim, places);
  Mean mean;
  for (const cv::Point place : places) {
    const cv::Point2d slope(normal_x.at<float>(place), normal_y.at<float>(place));
    const cv::Point2d normal = slope / std::max(1e-9, cv::norm(slope));
    double clearest = 0;
    for (int k = kRimFrom; k <= kRimTo; ++k) {
      const cv::Point at(cv::Point2d(place) + k * normal);
      if (!all.contains(at)) continue;
      const cv::Point2d edge(scene.x.at<float>(at), scene.y.at<float>(at));
      const double flat = kFlat;
      clearest = std::max(clearest, std::abs(edge.dot(normal)) / (cv::norm(edge) + flat));
    }
    mean.add(clearest);
  }
  const double share = static_cast<double>(places.size()) / std::max(1, cv::countNonZero(whole));
  return share * mean.value() + (1 - share) * kUsualRim;
}

/// No pixel has a colour: a grey camera or a grey picture.
bool is_grey(const cv::Mat& bgr) {
  cv::Mat channels[3];
  cv::split(bgr, channels);
  return cv::norm(channels[0], channels[1], cv::NORM_INF) == 0 &&
         cv::norm(channels[1], channels[2], cv::NORM_INF) == 0;
}

/// Median of right detections: says neither yes nor no.
constexpr double kUsualColourDifference = 0.08;

/// Shares of the channels: what a change of exposure leaves alone. Dark pixels, whose shares are
/// noise, count as grey.
double colour_difference(const cv::Mat& view, const cv::Mat& scene, const cv::Mat& mask) {
  constexpr double kDark = 10;
  cv::Mat a, b;
  cv::GaussianBlur(view, a, {}, 1.5);
  cv::GaussianBlur(scene, b, {}, 1.5);
  Mean mean;
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x) {
      if (!mask.at<uchar>(y, x)) continue;
      const cv::Vec3d p = a.at<cv::Vec3b>(y, x), q = b.at<cv::Vec3b>(y, x);
      const double sum_p = p[0] + p[1] + p[2] + 3 * kDark, sum_q = q[0] + q[1] + q[2] + 3 * kDark;
      double difference = 0;
      for (int c = 0; c < 3; ++c)
        difference += std::abs((p[c] + kDark) / sum_p - (q[c] + kDark) / sum_q);
      mean.add(difference);
    }
  return mean.value();
}

cv::Mat hull_mask(const std::vector<cv::Point2f>& points, const Patch& patch) {
  cv::Mat mask(patch.mask.size(), CV_8U, cv::Scalar(0));
  if (points.size() < 3) return mask;
  std::vector<cv::Point2f> hull;
  cv::convexHull(points, hull);
  std::vector<cv::Point> polygon;
  polygon.reserve(hull.size());
  for (const cv::Point2f& p : hull)
    polygon.emplace_back(cvRound((p.x - patch.corner.x) / patch.scale),
                         cvRound((p.y - patch.corner.y) / patch.scale));
  cv::fillConvexPoly(mask, polygon, cv::Scalar(255));
  cv::dilate(mask, mask, cv::getStructuringElement(cv::MORPH_RECT, {5, 5}));
  return mask;
}

/// The patch at the resolution at which the scene shows the object, or a little below.
Patch fitting(const Patch& patch, double scene_step) {
  Patch result = patch;
  constexpr double kEnlarged = 0.9;  // px of the scene per px of the patch: hardly enlarged
  constexpr int kSmallest = 12;      // px; a smaller patch shows nothing
  while (scene_step * result.scale < kEnlarged &&
         std::min(result.pixels.cols, result.pixels.rows) >= 2 * kSmallest)
    result = half_of(result);
  return result;
}

/// The patch with surroundings in which the rim can be looked for.
Patch with_surroundings(Patch patch) {
  constexpr int m = kRimTo + 2;
  cv::copyMakeBorder(patch.pixels, patch.pixels, m, m, m, m, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(patch.mask, patch.mask, m, m, m, m, cv::BORDER_CONSTANT);
  patch.corner -= cv::Point2d(m, m) * patch.scale;
  return patch;
}

}  // namespace

ScenePyramid::ScenePyramid(const cv::Mat& image) : levels_{to_bgr8(image)} {
  while (std::min(levels_.back().rows, levels_.back().cols) > kLeastSide &&
         static_cast<int>(levels_.size()) < kMostLevels) {
    cv::Mat half;
    cv::pyrDown(levels_.back(), half);
    levels_.push_back(half);
  }
  colour_ = !image.empty() && !is_grey(levels_.back());
}

void ScenePyramid::warp(const cv::Matx33d& scene_from_patch, double step, cv::Size size,
                        cv::Mat& pixels, cv::Mat& inside) const {
  std::size_t level = 0;
  for (; step > kStep && level + 1 < levels_.size(); step /= 2) ++level;
  const double shrink = std::ldexp(1.0, -static_cast<int>(level));
  const cv::Matx33d transform = cv::Matx33d::diag({shrink, shrink, 1}) * scene_from_patch;
  const int flags = cv::INTER_LINEAR | cv::WARP_INVERSE_MAP;
  cv::warpPerspective(levels_[level], pixels, transform, size, flags);
  const cv::Mat all(levels_[level].size(), CV_8U, cv::Scalar(255));
  cv::warpPerspective(all, inside, transform, size, flags);
  inside = inside > 250;
}

Agreement measure_agreement(const Patch& patch, const cv::Matx33d& scene_from_view,
                            const std::vector<cv::Point2f>& matched, const ScenePyramid& scene) {
  Agreement result;
  if (patch.empty() || matched.empty()) return result;
  const cv::Point2f centre =
      0.5F * (cv::Point2f(patch.corner) +
              transform_point(patch.view_from_patch(), cv::Point2f(cv::Point(patch.mask.size()))));
  const double step = std::sqrt(std::abs(cv::determinant(local_jacobian(scene_from_view, centre))));
  const Patch view = with_surroundings(fitting(patch, step));
  cv::Mat pixels, inside, inner;
  scene.warp(scene_from_view * view.view_from_patch(), step * view.scale, view.pixels.size(),
             pixels, inside);
  const cv::Mat mask = view.mask & inside;
  const int area = cv::countNonZero(view.mask), seen = cv::countNonZero(mask);
  if (seen == 0) return result;
  result.visible = static_cast<double>(seen) / area;
  cv::erode(mask, inner, cv::Mat());
  const Gradient of_scene(pixels);
  compare_structure(Gradient(view.pixels), of_scene, inner, hull_mask(matched, view), result);
  result.rim = rim_of(of_scene, view.mask, inside);
  result.colour_difference = scene.has_colour() && !is_grey(patch.pixels)
                                 ? colour_difference(view.pixels, pixels, mask)
                                 : kUsualColourDifference;
  return result;
}

}  // namespace posevote
