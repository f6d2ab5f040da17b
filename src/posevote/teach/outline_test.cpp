#include "posevote/teach/outline.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

cv::Mat empty_mask() {
  return cv::Mat::zeros(100, 120, CV_8U);
}

double area_of(const std::vector<cv::Point2f>& polygon) {
  return cv::contourArea(polygon);
}

TEST(OutlineOf, GivesTheCornersOfARectangle) {
  cv::Mat mask = empty_mask();
  mask(cv::Rect(20, 30, 40, 50)) = 255;
  const auto outline = outline_of(mask);
  EXPECT_EQ(outline.size(), 4U);
  EXPECT_EQ(cv::boundingRect(outline), cv::Rect(20, 30, 40, 50));
}

TEST(OutlineOf, StaysWithinAPixelOfADiscAndIsSimple) {
  cv::Mat mask = empty_mask();
  cv::circle(mask, {60, 50}, 40, cv::Scalar(255), cv::FILLED);
  const auto outline = outline_of(mask);
  EXPECT_TRUE(is_simple(outline));
  EXPECT_LT(outline.size(), 60U);
  for (const cv::Point2f p : outline) EXPECT_NEAR(cv::norm(p - cv::Point2f(60, 50)), 40, 1.5);
  EXPECT_NEAR(area_of(outline), CV_PI * 40 * 40, 0.03 * CV_PI * 40 * 40);
}

TEST(OutlineOf, KeepsADeepNotch) {
  cv::Mat mask = empty_mask();
  mask(cv::Rect(20, 20, 60, 60)) = 255;
  mask(cv::Rect(40, 20, 20, 40)) = 0;
  EXPECT_NEAR(area_of(outline_of(mask)), 59 * 59 - 20 * 40, 120);
}

TEST(OutlineOf, JoinsTwoPartsByTheirHull) {
  cv::Mat mask = empty_mask();
  mask(cv::Rect(10, 10, 20, 20)) = 255;
  mask(cv::Rect(70, 60, 20, 20)) = 255;
  const auto outline = outline_of(mask);
  EXPECT_TRUE(is_simple(outline));
  EXPECT_TRUE(cv::isContourConvex(outline));
  for (const cv::Point2f p : {cv::Point2f(15, 15), cv::Point2f(80, 70), cv::Point2f(50, 45)}) {
    EXPECT_GT(cv::pointPolygonTest(outline, p, false), 0);
  }
}

TEST(OutlineOf, OfOnePixelOrALineHasAnArea) {
  for (const cv::Rect part : {cv::Rect(5, 5, 1, 1), cv::Rect(5, 5, 30, 1), cv::Rect(5, 5, 1, 30)}) {
    cv::Mat mask = empty_mask();
    mask(part) = 255;
    const auto outline = outline_of(mask);
    ASSERT_GE(outline.size(), 3U);
    EXPECT_TRUE(is_simple(outline));
    EXPECT_NEAR(area_of(outline), part.area(), 1e-3);
  }
}

TEST(OutlineOf, StaysSimpleWhereTheBorderTouchesItself) {
  cv::Mat mask = empty_mask();
  mask(cv::Rect(10, 10, 30, 30)) = 255;
  mask(cv::Rect(40, 40, 30, 30)) = 255;  // joined by a corner only
  mask.row(25).colRange(40, 90) = 255;   // a hair
  EXPECT_TRUE(is_simple(outline_of(mask)));
}

TEST(OutlineOf, CoversTheWholePicture) {
  const auto outline = outline_of(cv::Mat(10, 12, CV_8U, cv::Scalar(255)));
  EXPECT_EQ(cv::boundingRect(outline), cv::Rect(0, 0, 12, 10));
  EXPECT_GE(outline_of(cv::Mat(1, 1, CV_8U, cv::Scalar(255))).size(), 3U);
}

TEST(OutlineOf, IsEmptyForAnEmptyMask) {
  EXPECT_TRUE(outline_of(empty_mask()).empty());
}

TEST(CentroidOf, IsTheMeanOfThePixels) {
  cv::Mat mask = empty_mask();
  mask(cv::Rect(20, 30, 11, 21)) = 255;
  EXPECT_EQ(centroid_of(mask), cv::Point2f(25, 40));
}

TEST(IsSimple, TellsCrossingsTouchesAndSpikes) {
  EXPECT_TRUE(is_simple({{0, 0}, {4, 0}, {4, 4}, {0, 4}}));
  EXPECT_FALSE(is_simple({{0, 0}, {4, 4}, {4, 0}, {0, 4}}));          // bow tie
  EXPECT_FALSE(is_simple({{0, 0}, {4, 0}, {2, 0}, {2, 4}}));          // goes back over itself
  EXPECT_FALSE(is_simple({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}));  // touches its first side
  EXPECT_FALSE(is_simple({{0, 0}, {4, 0}}));
}

}  // namespace
}  // namespace posevote
