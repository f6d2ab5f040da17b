#include "posevote/teach/shortened.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "posevote/teach/made_pictures.hpp"
#include "posevote/teach/repeatable.hpp"

namespace posevote {
namespace {

TEST(Shorten, TakesWholePixelsAndSaysWhatCameOut) {
  const cv::Mat picture(301, 480, CV_8UC3, cv::Scalar(9, 9, 9));
  const ShortenedPicture copy = shorten(picture, cv::Mat(picture.size(), CV_8U), 1, kFromAside);
  EXPECT_EQ(copy.picture.size(), cv::Size(480, 213));
  EXPECT_EQ(copy.mask.size(), copy.picture.size());
  EXPECT_DOUBLE_EQ(copy.fx, 1);
  EXPECT_DOUBLE_EQ(copy.fy, 213.0 / 301);
  EXPECT_EQ(shorten(cv::Mat(1, 1, CV_8U), {}, 0.1, 0.1).picture.size(), cv::Size(1, 1));
}

TEST(Lengthen, UndoesShortening) {
  Features features;
  features.keypoints.push_back({10, 20, 2, 0, 1, 1});
  const auto diagonal = static_cast<float>(std::atan2(0.5, 1.0));  // of what was 45 degrees
  features.keypoints.push_back({-0.5F, -0.5F, 2, diagonal, 1, 1});
  const Features own = lengthen(features, 1, 0.5);
  EXPECT_FLOAT_EQ(own.keypoints[0].x, 10);
  EXPECT_FLOAT_EQ(own.keypoints[0].y, 40.5F);  // pixel centres lie at halves of the border's frame
  EXPECT_FLOAT_EQ(own.keypoints[0].scale, static_cast<float>(2 * std::sqrt(2)));
  EXPECT_FLOAT_EQ(own.keypoints[0].angle, 0);
  EXPECT_FLOAT_EQ(own.keypoints[1].x, -0.5F);
  EXPECT_FLOAT_EQ(own.keypoints[1].y, -0.5F);
  EXPECT_NEAR(own.keypoints[1].angle, std::atan(1.0), 1e-6);
}

TEST(Lengthen, PutsFeaturesOnTheSpotsOfThePicture) {
  FeatureOptions options;
  options.kind = "sift";
  const auto extractor = make_extractor(options);
  const cv::Mat picture = made::box_art({240, 300});
  const ShortenedPicture copy = shorten(picture, {}, 1, 0.9);
  const Features own = lengthen(extractor->extract(copy.picture), copy.fx, copy.fy);
  const auto found = find_likenesses(own, {extractor->extract(picture), 1, 1});
  const auto right = std::ranges::count_if(found, [](float d) { return std::isfinite(d); });
  ASSERT_GT(own.size(), 50);
  EXPECT_GT(static_cast<double>(right), 0.6 * static_cast<double>(own.size()));
}

}  // namespace
}  // namespace posevote
