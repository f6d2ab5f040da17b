#include "posevote/teach/teacher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "posevote/core/error.hpp"
#include "posevote/teach/made_pictures.hpp"
#include "posevote/teach/repeatable.hpp"

namespace posevote {
namespace {

using ::testing::HasSubstr;

TeachOptions sift() {
  TeachOptions options;
  options.feature.kind = "sift";  // present in every build
  return options;
}

// SIFT and any filter need a few textured pixels: the box, large.
cv::Mat print() {
  return made::box_art({120, 150});
}

ViewSource whole(const cv::Mat& picture) {
  ViewSource source;
  source.picture = picture;
  return source;
}

void expect_refused(const ViewSource& source, ErrorCode code, const std::string& advice,
                    const TeachOptions& options = sift()) {
  try {
    (void)teach_view(source, options);
    FAIL() << "not refused; expected: " << advice;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_THAT(error.what(), HasSubstr(advice));
  }
}

TEST(TeachView, TakesTheWholePictureWhenNothingElseIsGiven) {
  ViewSource source = whole(print());
  source.yaw_deg = 30;
  const View view = teach_view(source, sift());
  EXPECT_EQ(view.image_size, cv::Size(120, 150));
  EXPECT_EQ(cv::countNonZero(view.mask), 120 * 150);
  EXPECT_EQ(view.centre, cv::Point2f(59.5F, 74.5F));
  EXPECT_EQ(cv::boundingRect(view.outline), cv::Rect(0, 0, 120, 150));
  EXPECT_EQ(view.yaw_deg, 30);
  EXPECT_GE(view.features.size(), 8U);
  EXPECT_EQ(cv::norm(view.picture, source.picture, cv::NORM_INF), 0);
}

TEST(TeachView, OwnsItsPicture) {
  cv::Mat picture = print();
  const View view = teach_view(whole(picture), sift());
  picture.setTo(0);
  EXPECT_GT(cv::norm(view.picture), 0);
}

TEST(TeachView, LeavesTheYawUnknownUnlessGiven) {
  EXPECT_TRUE(std::isnan(teach_view(whole(print()), sift()).yaw_deg));
}

TEST(TeachView, KeepsFeaturesInsideTheMaskOnly) {
  const auto s = made::scene();
  ViewSource source = whole(s.picture);
  source.mask = s.truth;
  const View view = teach_view(source, sift());
  EXPECT_EQ(cv::norm(view.mask, s.truth, cv::NORM_INF), 0);
  for (const Keypoint& k : view.features.keypoints) {
    EXPECT_NE(s.truth.at<uchar>(cvRound(k.y), cvRound(k.x)), 0);
  }
}

TEST(TeachView, SubtractsTheBackground) {
  const auto s = made::scene();
  ViewSource source = whole(s.picture);
  source.background = s.background;
  const View view = teach_view(source, sift());
  EXPECT_GT(made::iou(view.mask, s.truth), 0.97);
  EXPECT_NEAR(view.centre.x, 159.5, 1);
  EXPECT_NEAR(view.centre.y, 119.5, 1);
}

TEST(TeachView, PrefersTheMaskToTheBackground) {
  const auto s = made::scene();
  ViewSource source = whole(s.picture);
  source.background = s.background;
  source.mask = cv::Mat::zeros(s.picture.size(), CV_8U);
  source.mask(cv::Rect(130, 80, 50, 60)) = 255;
  EXPECT_EQ(cv::countNonZero(teach_view(source, sift()).mask), 50 * 60);
}

TEST(TeachView, TakesAMaskOfAnyType) {
  const auto s = made::scene();
  ViewSource source = whole(s.picture);
  cv::cvtColor(s.truth, source.mask, cv::COLOR_GRAY2BGR);
  EXPECT_EQ(cv::norm(find_object(source), s.truth, cv::NORM_INF), 0);
  s.truth.convertTo(source.mask, CV_16U, 257);
  EXPECT_EQ(cv::norm(find_object(source), s.truth, cv::NORM_INF), 0);
}

TEST(TeachView, CutsTheRectangleToThePicture) {
  ViewSource source = whole(print());
  source.roi = cv::Rect(-10, -10, 100, 100);
  EXPECT_EQ(cv::boundingRect(teach_view(source, sift()).mask), cv::Rect(0, 0, 90, 90));
}

TEST(TeachView, TakesTheOpaquePartOfATransparentPicture) {
  cv::Mat planes[4];
  cv::split(print(), planes);
  planes[3] = cv::Mat::zeros(planes[0].size(), CV_8U);
  planes[3](cv::Rect(10, 20, 90, 100)) = 255;
  cv::Mat picture;
  cv::merge(planes, 4, picture);
  const View view = teach_view(whole(picture), sift());
  EXPECT_EQ(cv::boundingRect(view.mask), cv::Rect(10, 20, 90, 100));
  EXPECT_EQ(view.picture.type(), CV_8UC3);
  planes[3].setTo(255);
  cv::merge(planes, 4, picture);
  EXPECT_EQ(cv::countNonZero(teach_view(whole(picture), sift()).mask), 120 * 150);
  planes[3].setTo(0);
  cv::merge(planes, 4, picture);
  expect_refused(whole(picture), ErrorCode::unusable_view, "mask is empty");
}

TEST(TeachView, TakesGreyAnd16BitPictures) {
  cv::Mat grey, deep;
  cv::cvtColor(print(), grey, cv::COLOR_BGR2GRAY);
  EXPECT_EQ(teach_view(whole(grey), sift()).picture.type(), CV_8UC3);
  print().convertTo(deep, CV_16U, 257);
  const View view = teach_view(whole(deep), sift());
  EXPECT_EQ(view.picture.type(), CV_8UC3);
  EXPECT_EQ(cv::norm(view.picture, print(), cv::NORM_INF), 0);
}

TEST(TeachView, LeavesOutFeaturesNearTheSilhouetteOnRequest) {
  TeachOptions options = sift();
  const auto all = teach_view(whole(print()), options).features;
  options.border_scales = 4;
  const auto inner = teach_view(whole(print()), options).features;
  EXPECT_LT(inner.size(), all.size());
  EXPECT_EQ(inner.descriptors.rows, static_cast<int>(inner.size()));
  for (const Keypoint& k : inner.keypoints) {
    const float margin = std::min({k.x + 1, k.y + 1, 120 - k.x, 150 - k.y});
    EXPECT_GT(margin, 4 * k.scale - 1);
  }
}

TEST(TeachView, KnowsTheObjectFromAboveToo) {
  TeachOptions options = sift();
  options.foreshortened = false;
  const cv::Mat picture = print();
  const View level = teach_view(whole(picture), options);
  options.foreshortened = true;
  const View both = teach_view(whole(picture), options);
  EXPECT_EQ(level.outline, both.outline);
  EXPECT_EQ(both.features.descriptors.rows, static_cast<int>(both.features.size()));
  EXPECT_TRUE(
      std::ranges::is_sorted(both.features.keypoints, std::ranges::greater(), &Keypoint::response));
  for (const Keypoint& k : both.features.keypoints)
    EXPECT_TRUE(cv::Rect2f(-1, -1, 122, 152).contains({k.x, k.y}));

  // The same print from 50 degrees above is told by more of them.
  cv::Mat above;
  cv::resize(picture, above, {}, 1, std::cos(50 * CV_PI / 180), cv::INTER_AREA);
  const Features seen = make_extractor(options.feature)->extract(above);
  const auto likenesses = [&](const View& view) {
    const ShortenedFeatures scene{seen, 1, above.rows / static_cast<double>(picture.rows)};
    return std::ranges::count_if(find_likenesses(view.features, scene),
                                 [](float distance) { return distance < 0.4F; });
  };
  EXPECT_GT(likenesses(both), 1.3 * static_cast<double>(likenesses(level)));
}

TEST(TeachView, PaintedSurroundingsDoNotReachTheFeatures) {
  TeachOptions options = sift();
  options.paint_surroundings = true;
  auto s = made::scene();
  ViewSource source = whole(s.picture.clone());
  source.mask = s.truth;
  const auto before = teach_view(source, options).features;
  source.picture.setTo(cv::Scalar(0, 255, 0), s.truth == 0);
  const auto after = teach_view(source, options).features;
  ASSERT_EQ(before.size(), after.size());
  EXPECT_EQ(cv::norm(before.descriptors, after.descriptors, cv::NORM_INF), 0);
}

TEST(TeachView, RefusesAPictureWithoutFeatures) {
  expect_refused(whole(cv::Mat(100, 100, CV_8UC3, cv::Scalar::all(80))), ErrorCode::unusable_view,
                 "only 0 features");
  expect_refused(whole(cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(80))), ErrorCode::unusable_view,
                 "only 0 features");
}

TEST(TeachView, RefusesOneFeatureLessThanTheMinimum) {
  TeachOptions options = sift();
  options.min_features = static_cast<int>(teach_view(whole(print()), sift()).features.size());
  EXPECT_NO_THROW((void)teach_view(whole(print()), options));
  ++options.min_features;
  expect_refused(whole(print()), ErrorCode::unusable_view, "are needed", options);
}

TEST(TeachView, RefusesMasksAndRectanglesThatDoNotFit) {
  ViewSource source = whole(print());
  source.mask = cv::Mat(150, 121, CV_8U, cv::Scalar(255));
  expect_refused(source, ErrorCode::invalid_argument, "121 x 150");
  source.mask = cv::Mat::zeros(150, 120, CV_8U);
  expect_refused(source, ErrorCode::unusable_view, "mask is empty");
  source.mask.release();
  source.roi = cv::Rect(120, 0, 10, 10);
  expect_refused(source, ErrorCode::invalid_argument, "outside the picture");
  source.roi = cv::Rect(10, 10, 0, 10);
  expect_refused(source, ErrorCode::invalid_argument, "outside the picture");
  expect_refused(ViewSource(), ErrorCode::invalid_argument, "empty");
}

TEST(TeachView, RefusesOptionsOutOfRange) {
  TeachOptions options = sift();
  options.min_features = 0;
  expect_refused(whole(print()), ErrorCode::invalid_argument, "min_features", options);
}

TEST(TeachView, TeachesADemoView) {
  const std::string demo = std::string(POSEVOTE_SOURCE_DIR) + "/data/demo/train/tea-mint/";
  ViewSource source = whole(cv::imread(demo + "y000.jpg"));
  source.background = cv::imread(demo + "background.jpg");
  const View view = teach_view(source, sift());
  EXPECT_GT(view.features.size(), 100U);
  EXPECT_GE(view.outline.size(), 4U);
  EXPECT_GT(cv::pointPolygonTest(view.outline, view.centre, false), 0);
}

}  // namespace
}  // namespace posevote
