#include "posevote/teach/outline.hpp"

#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

double cross(cv::Point2f a, cv::Point2f b, cv::Point2f c) {
  return static_cast<double>(b.x - a.x) * (c.y - a.y) -
         static_cast<double>(b.y - a.y) * (c.x - a.x);
}

bool is_between(cv::Point2f a, cv::Point2f b, cv::Point2f p) {
  return p.x >= std::min(a.x, b.x) && p.x <= std::max(a.x, b.x) && p.y >= std::min(a.y, b.y) &&
         p.y <= std::max(a.y, b.y);
}

bool meet(cv::Point2f a, cv::Point2f b, cv::Point2f c, cv::Point2f d) {
  const double abc = cross(a, b, c), abd = cross(a, b, d);
  const double cda = cross(c, d, a), cdb = cross(c, d, b);
  if (((abc > 0) != (abd > 0)) && ((cda > 0) != (cdb > 0)) && abc * abd != 0 && cda * cdb != 0) {
    return true;
  }
  return (abc == 0 && is_between(a, b, c)) || (abd == 0 && is_between(a, b, d)) ||
         (cda == 0 && is_between(c, d, a)) || (cdb == 0 && is_between(c, d, b));
}

// Of the pixels' outer corners, so that a single pixel has one too.
std::vector<cv::Point2f> hull_of(const std::vector<std::vector<cv::Point>>& contours) {
  std::vector<cv::Point2f> corners, hull;
  for (const auto& contour : contours) {
    for (const cv::Point p : contour) {
      const cv::Point2f centre = p;
      for (const float dx : {-0.5F, 0.5F}) {
        for (const float dy : {-0.5F, 0.5F}) corners.push_back(centre + cv::Point2f(dx, dy));
      }
    }
  }
  cv::convexHull(corners, hull);
  return hull;
}

}  // namespace

bool is_simple(const std::vector<cv::Point2f>& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const cv::Point2f a = polygon[i], b = polygon[(i + 1) % n];
    if (a == b) return false;
    // The next side turned straight back over this one.
    const cv::Point2f c = polygon[(i + 2) % n];
    if (cross(a, b, c) == 0 && (b - a).dot(c - b) < 0) return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (meet(a, b, polygon[j], polygon[(j + 1) % n])) return false;
    }
  }
  return true;
}

std::vector<cv::Point2f> outline_of(const cv::Mat& mask, double tolerance_px) {
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
  if (contours.empty()) return {};
  if (contours.size() == 1) {
    for (const double tolerance : {tolerance_px, tolerance_px / 2, 0.0}) {
      std::vector<cv::Point> simplified;
      cv::approxPolyDP(contours[0], simplified, tolerance, true);
      std::vector<cv::Point2f> polygon(simplified.begin(), simplified.end());
      if (is_simple(polygon)) return polygon;
    }
  }
  return hull_of(contours);
}

cv::Point2f centroid_of(const cv::Mat& mask) {
  const cv::Moments m = cv::moments(mask, true);
  return {static_cast<float>(m.m10 / m.m00), static_cast<float>(m.m01 / m.m00)};
}

}  // namespace posevote
