#include "posevote/model/patch.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

/// Left half blue, right half red, inside a white box.
cv::Mat two_colours(cv::Size size, const cv::Rect& box) {
  cv::Mat picture(size, CV_8UC3, cv::Scalar::all(255));
  cv::rectangle(picture, box, {200, 0, 0}, cv::FILLED);
  cv::rectangle(picture, cv::Rect(box.x + box.width / 2, box.y, box.width / 2, box.height),
                {0, 0, 200}, cv::FILLED);
  return picture;
}

cv::Mat mask_of(cv::Size size, const cv::Rect& box) {
  cv::Mat mask(size, CV_8U, cv::Scalar(0));
  mask(box) = 255;
  return mask;
}

TEST(MakePatch, ReducesTheObjectToTheSizeOfASquareOf64) {
  const cv::Rect box(100, 50, 256, 256);
  const Patch patch = make_patch(two_colours({640, 480}, box), mask_of({640, 480}, box));
  EXPECT_DOUBLE_EQ(patch.scale, 4);
  EXPECT_NEAR(cv::countNonZero(patch.mask), 64 * 64, 4 * 64);
}

TEST(MakePatch, KeepsThePlaceOfEveryPixel) {
  const cv::Rect box(100, 50, 256, 256);
  const Patch patch = make_patch(two_colours({640, 480}, box), mask_of({640, 480}, box));
  for (int y = 0; y < patch.mask.rows; ++y)
    for (int x = 0; x < patch.mask.cols; ++x) {
      if (!patch.mask.at<uchar>(y, x)) continue;
      const cv::Vec3d place = patch.view_from_patch() * cv::Vec3d(x, y, 1);
      ASSERT_TRUE(box.contains(cv::Point(cvRound(place[0]), cvRound(place[1]))));
      if (std::abs(place[0] - 227.5) < 6) continue;  // at the edge of the two colours
      const cv::Vec3b colour = patch.pixels.at<cv::Vec3b>(y, x);
      ASSERT_EQ(colour[0] > colour[2], place[0] < 228) << x << ' ' << y;
    }
}

TEST(MakePatch, DoesNotEnlargeASmallObject) {
  const cv::Rect box(5, 5, 20, 30);
  const Patch patch = make_patch(two_colours({60, 60}, box), mask_of({60, 60}, box));
  EXPECT_DOUBLE_EQ(patch.scale, 1);
  EXPECT_EQ(cv::countNonZero(patch.mask), box.area());
}

TEST(MakePatch, TakesObjectsThatFillThePictureAndNone) {
  const cv::Rect all(0, 0, 200, 200);
  EXPECT_FALSE(make_patch(two_colours(all.size(), all), mask_of(all.size(), all)).empty());
  EXPECT_TRUE(make_patch(two_colours(all.size(), all), cv::Mat::zeros(200, 200, CV_8U)).empty());
}

TEST(HalfOf, ShowsTheSamePlaceWithHalfThePixels) {
  const cv::Rect box(100, 50, 256, 256);
  const Patch patch = make_patch(two_colours({640, 480}, box), mask_of({640, 480}, box));
  const Patch half = half_of(patch);
  EXPECT_EQ(half.pixels.cols, patch.pixels.cols / 2);
  const cv::Vec3d fine = patch.view_from_patch() * cv::Vec3d(2.5, 4.5, 1);
  const cv::Vec3d coarse = half.view_from_patch() * cv::Vec3d(1, 2, 1);
  EXPECT_NEAR(cv::norm(fine - coarse), 0, 1e-9);
}

}  // namespace
}  // namespace posevote
