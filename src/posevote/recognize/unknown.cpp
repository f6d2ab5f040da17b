#include "posevote/recognize/unknown.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

constexpr int kCells = 48;           // along the longer side of the picture
constexpr int kDense = 2;            // features in a cell
constexpr double kLeastArea = 0.01;  // of the picture

/// CV_8U 0/255, a pixel for each cell: where a detection's outline lies.
cv::Mat explained_cells(const std::vector<Detection>& detections, cv::Size cells, double cell) {
  cv::Mat explained(cells, CV_8U, cv::Scalar(0));
  for (const Detection& detection : detections) {
    std::vector<cv::Point> polygon;
    for (const cv::Point2f& point : detection.outline)
      polygon.emplace_back(cvFloor(point.x / cell), cvFloor(point.y / cell));
    if (!polygon.empty()) cv::fillPoly(explained, {polygon}, cv::Scalar(255));
  }
  cv::dilate(explained, explained, cv::Mat());
  return explained;
}

}  // namespace

std::vector<UnknownRegion> find_unknown(const Features& scene, cv::Size size,
                                        const std::vector<Detection>& detections) {
  if (size.empty()) return {};
  const double cell =
      std::max(8.0, std::max(size.width, size.height) / static_cast<double>(kCells));
  const cv::Size cells(cvCeil(size.width / cell), cvCeil(size.height / cell));
  cv::Mat counts(cells, CV_32S, cv::Scalar(0));
  for (const Keypoint& k : scene.keypoints) {
    const int x = std::clamp(cvFloor(k.x / cell), 0, cells.width - 1);
    const int y = std::clamp(cvFloor(k.y / cell), 0, cells.height - 1);
    ++counts.at<int>(y, x);
  }
  cv::Mat dense = (counts >= kDense) & ~explained_cells(detections, cells, cell);
  cv::morphologyEx(dense, dense, cv::MORPH_CLOSE, cv::Mat());
  cv::morphologyEx(dense, dense, cv::MORPH_OPEN, cv::Mat());

  cv::Mat labels, stats, centroids;
  const int components = cv::connectedComponentsWithStats(dense, labels, stats, centroids, 8);
  std::vector<UnknownRegion> found;
  for (int label = 1; label < components; ++label) {
    if (stats.at<int>(label, cv::CC_STAT_AREA) < kLeastArea * cells.area()) continue;
    const cv::Rect2d box(stats.at<int>(label, cv::CC_STAT_LEFT) * cell,
                         stats.at<int>(label, cv::CC_STAT_TOP) * cell,
                         stats.at<int>(label, cv::CC_STAT_WIDTH) * cell,
                         stats.at<int>(label, cv::CC_STAT_HEIGHT) * cell);
    const double features =
        cv::mean(counts, labels == label)[0] * cv::countNonZero(labels == label);
    found.push_back({cv::Rect2f(box & cv::Rect2d({}, cv::Size2d(size))), cvRound(features)});
  }
  std::ranges::stable_sort(found, std::ranges::greater(), &UnknownRegion::features);
  return found;
}

}  // namespace posevote
