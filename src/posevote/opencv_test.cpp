#include "posevote/opencv.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "posevote/core/error.hpp"
#include "posevote/feature/features.hpp"
#include "posevote/feature/made_pictures.hpp"
#if POSEVOTE_WITH_SURF
#include "posevote/feature/surf/surf_extractor.hpp"
#endif

namespace posevote {
namespace {

#if POSEVOTE_WITH_SURF

TEST(CreateSurf, SaysWhatItsDescriptorsAre) {
  const auto surf = create_surf();
  EXPECT_EQ(surf->descriptorSize(), 64);
  EXPECT_EQ(surf->descriptorType(), CV_32F);
  EXPECT_EQ(surf->defaultNorm(), cv::NORM_L2);
}

TEST(CreateSurf, GivesTheExtractorsFeaturesInOpenCvsUnits) {
  const cv::Mat picture = made::texture(200, 150);
  std::vector<cv::KeyPoint> points;
  cv::Mat descriptors;
  create_surf(100, 40)->detectAndCompute(picture, {}, points, descriptors);
  FeatureOptions options;
  options.max_features = 40;
  const auto features = make_surf_extractor(options)->extract(picture);
  ASSERT_EQ(points.size(), 40U);
  EXPECT_EQ(cv::norm(descriptors, features.descriptors, cv::NORM_INF), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_FLOAT_EQ(points[i].size, features.keypoints[i].scale * 7.5F);
    EXPECT_EQ(points[i].class_id, features.keypoints[i].laplacian);
    EXPECT_GE(points[i].angle, 0);
    EXPECT_LT(points[i].angle, 360);
    EXPECT_NEAR(
        std::remainder(points[i].angle * CV_PI / 180 - features.keypoints[i].angle, 2 * CV_PI), 0,
        1e-5);
  }
}

TEST(CreateSurf, DetectThenComputeIsDetectAndCompute) {
  const cv::Mat picture = made::texture(200, 150);
  std::vector<cv::KeyPoint> together, apart;
  cv::Mat expected, found;
  const auto surf = create_surf(200);
  surf->detectAndCompute(picture, {}, together, expected);
  surf->detect(picture, apart);
  surf->compute(picture, apart, found);
  ASSERT_FALSE(together.empty());
  ASSERT_EQ(apart.size(), together.size());
  for (std::size_t i = 0; i < apart.size(); ++i) {
    EXPECT_EQ(apart[i].pt, together[i].pt);
    EXPECT_EQ(apart[i].angle, together[i].angle);
  }
  EXPECT_LT(cv::norm(expected, found, cv::NORM_INF), 1e-3);
}

TEST(CreateSurf, DescribesPointsOfOtherDetectorsWhereverTheyAre) {
  const cv::Mat picture = made::texture(200, 150);
  std::vector<cv::KeyPoint> points;
  cv::FAST(picture, points, 20);
  const float infinite = std::numeric_limits<float>::infinity();
  for (const float far : {-1e30F, -500.0F, 0.0F, 199.9F, 1e9F, infinite, -infinite})
    points.emplace_back(far, far, 7.0F);
  for (const float size : {0.0F, -1.0F, 1e-20F, 1e20F, std::nanf("")})
    points.emplace_back(50.0F, 50.0F, size);
  const std::size_t count = points.size();
  cv::Mat descriptors;
  create_surf()->compute(picture, points, descriptors);
  ASSERT_EQ(points.size(), count);
  ASSERT_EQ(descriptors.rows, static_cast<int>(count));
  for (int i = 0; i < descriptors.rows; ++i) EXPECT_NEAR(cv::norm(descriptors.row(i)), 1, 1e-4);
}

TEST(CreateSurf, HonoursTheMaskAndTheThreshold) {
  const cv::Mat picture = made::texture(200, 150);
  cv::Mat mask = cv::Mat::zeros(picture.size(), CV_8U);
  mask.rowRange(0, 75).setTo(255);
  std::vector<cv::KeyPoint> all, upper, strong;
  create_surf()->detect(picture, all);
  create_surf()->detect(picture, upper, mask);
  create_surf(1000)->detect(picture, strong);
  EXPECT_GT(upper.size(), 0U);
  EXPECT_LT(upper.size(), all.size());
  for (const auto& point : upper) EXPECT_LE(point.pt.y, 74.5F);
  EXPECT_LT(strong.size(), all.size());
  for (const auto& point : strong) EXPECT_GE(point.response, 1000);
}

TEST(CreateSurf, EmptyAndFlatPicturesHaveNothing) {
  const auto surf = create_surf();
  for (const cv::Mat& picture : {cv::Mat(), cv::Mat(60, 80, CV_8UC3, cv::Scalar::all(90))}) {
    std::vector<cv::KeyPoint> points(3);
    cv::Mat descriptors(3, 64, CV_32F);
    surf->detectAndCompute(picture, {}, points, descriptors);
    EXPECT_TRUE(points.empty());
    EXPECT_TRUE(descriptors.empty());
    points.resize(3);
    surf->detect(picture, points);
    EXPECT_TRUE(points.empty());
  }
}

TEST(CreateSurf, ComputeWithoutPointsGivesNoRows) {
  std::vector<cv::KeyPoint> none;
  cv::Mat descriptors(3, 64, CV_32F);
  create_surf()->compute(made::texture(60, 50), none, descriptors);
  EXPECT_TRUE(descriptors.empty());
}

TEST(CreateSurf, RefusesValuesOutOfRange) {
  EXPECT_THROW((void)create_surf(-1), Error);
  EXPECT_THROW((void)create_surf(100, -1), Error);
}

#else

TEST(CreateSurf, SaysThatTheBuildHasNoSurf) {
  EXPECT_THROW((void)create_surf(), Error);
}

#endif

}  // namespace
}  // namespace posevote
