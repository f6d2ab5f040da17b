#include "posevote/render/draw_explanation.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

const cv::Scalar kFound(80, 200, 60), kRefused(0, 140, 255), kMatch(255, 230, 60);

cv::Mat dimmed(const cv::Mat& image, double factor) {
  cv::Mat bgr;
  cv::cvtColor(to_grey(image), bgr, cv::COLOR_GRAY2BGR);
  return bgr * factor;
}

bool is_inside(const cv::Point2f& point, const cv::Mat& image) {
  return point.x >= 0 && point.y >= 0 && point.x < static_cast<float>(image.cols) &&
         point.y < static_cast<float>(image.rows);
}

/// Number of votes about every pixel, as a grey picture whose peak is white.
cv::Mat accumulator(const std::vector<cv::Point2f>& centres, cv::Size size) {
  cv::Mat votes(size, CV_32F, cv::Scalar(0));
  for (const cv::Point2f& centre : centres)
    if (is_inside(centre, votes))
      votes.at<float>(static_cast<int>(centre.y), static_cast<int>(centre.x)) += 1;
  const double sigma = std::max(2.0, 0.015 * std::min(size.width, size.height));
  cv::GaussianBlur(votes, votes, {}, sigma, sigma, cv::BORDER_CONSTANT);
  cv::Mat grey;
  cv::normalize(votes, grey, 0, 255, cv::NORM_MINMAX, CV_8U);
  return centres.empty() ? cv::Mat::zeros(size, CV_8U) : grey;
}

void draw_outline(cv::Mat& picture, const Explanation& explanation, int thickness) {
  if (!explanation.best) return;
  std::vector<cv::Point> polygon;
  constexpr float kFar = 1e5F;  // OpenCV draws with integers
  for (const cv::Point2f& p : explanation.best->outline)
    polygon.emplace_back(cvRound(std::clamp(p.x, -kFar, kFar)),
                         cvRound(std::clamp(p.y, -kFar, kFar)));
  if (!polygon.empty())
    cv::polylines(picture, polygon, true, explanation.found ? kFound : kRefused, thickness,
                  cv::LINE_AA);
}

}  // namespace

cv::Mat draw_explanation(const cv::Mat& image, const Explanation& explanation) {
  const int thickness = std::max(2, std::min(image.rows, image.cols) / 200);
  cv::Mat scene = dimmed(image, 0.7);
  for (const MatchedPoint& match : explanation.matches)
    cv::circle(scene, match.scene, thickness + 1, kMatch, thickness / 2, cv::LINE_AA);
  if (explanation.best)
    for (const MatchedPoint& match : explanation.best->matches)
      cv::circle(scene, match.scene, thickness, explanation.found ? kFound : kRefused, cv::FILLED,
                 cv::LINE_AA);
  draw_outline(scene, explanation, thickness);

  cv::Mat heat, both;
  cv::applyColorMap(accumulator(explanation.vote_centres, image.size()), heat,
                    cv::COLORMAP_INFERNO);
  heat = heat + dimmed(image, 0.2);
  cv::hconcat(scene, heat, both);
  return both;
}

}  // namespace posevote
