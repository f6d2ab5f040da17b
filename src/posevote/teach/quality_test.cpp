#include "posevote/teach/quality.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posevote/core/error.hpp"
#include "posevote/teach/made_pictures.hpp"
#include "posevote/teach/teacher.hpp"

namespace posevote {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

QualityOptions sift() {
  QualityOptions options;
  options.feature.kind = "sift";
  return options;
}

View taught(const cv::Mat& picture, double yaw_deg = std::nan("")) {
  TeachOptions options;
  options.feature.kind = "sift";
  options.min_features = 1;
  ViewSource source;
  source.picture = picture;
  source.yaw_deg = yaw_deg;
  return teach_view(source, options);
}

cv::Mat rich(int seed = 7) {
  return made::box_art({240, 300}, seed);
}

// Sixty patches on 240 x 300 px, and the same 40 px tile again and again.
cv::Mat tiled() {
  return cv::repeat(made::box_art({40, 50}), 6, 6);
}

TEST(AssessView, FindsNothingWrongWithARichPicture) {
  const ViewQuality quality = assess_view(taught(rich()), {}, sift());
  EXPECT_GT(quality.features, 60U);
  EXPECT_EQ(quality.size_px, 300);
  EXPECT_GT(quality.coverage, 0.35);
  EXPECT_LT(quality.self_similarity, 0.3);
  EXPECT_LT(quality.smallest_size_px, 120);
  EXPECT_EQ(quality.redundancy, 0);
  EXPECT_TRUE(std::isnan(quality.next_yaw_deg));
  EXPECT_THAT(quality.advice, ::testing::IsEmpty());
}

TEST(MeasureRedundancy, IsHighForTheSameSideAndLowForAnother) {
  const auto front = std::make_shared<View>(taught(rich(7)));
  cv::Mat again = rich(7);
  made::add_noise(again, 1, 1);
  EXPECT_GT(measure_redundancy(taught(again), {front}, sift()), 0.8);
  EXPECT_LT(measure_redundancy(taught(rich(8)), {front}, sift()), 0.5);
  EXPECT_EQ(measure_redundancy(*front, {front}, sift()), 0);
  EXPECT_EQ(measure_redundancy(View(), {front}, sift()), 0);
}

TEST(AssessView, SeesRepeatedTexture) {
  const ViewQuality quality = assess_view(taught(tiled()), {}, sift());
  EXPECT_GT(quality.self_similarity, 0.6);
  EXPECT_THAT(quality.advice, Contains(HasSubstr("texture repeats")));
}

TEST(AssessView, SeesThatPrintCoversACornerOnly) {
  cv::Mat picture(300, 240, CV_8UC3, cv::Scalar::all(150));
  made::box_art({70, 80}).copyTo(picture(cv::Rect(20, 20, 70, 80)));
  const ViewQuality quality = assess_view(taught(picture), {}, sift());
  EXPECT_LT(quality.coverage, 0.25);
  EXPECT_THAT(quality.advice, Contains(HasSubstr("cover only")));
}

TEST(AssessView, NeedsMorePixelsWithFewFeatures) {
  cv::Mat picture(300, 240, CV_8UC3, cv::Scalar::all(150));
  made::box_art({20, 26}).copyTo(picture(cv::Rect(100, 100, 20, 26)));
  const ViewQuality poor = assess_view(taught(picture), {}, sift());
  const ViewQuality good = assess_view(taught(rich()), {}, sift());
  EXPECT_GT(poor.smallest_size_px, good.smallest_size_px);
  EXPECT_THAT(poor.advice, Contains(HasSubstr("features; take the picture")));
}

TEST(AssessView, SeesThatAViewIsKnownAlready) {
  const View view = taught(rich());
  const auto same = std::make_shared<View>(taught(rich()));
  const auto other = std::make_shared<View>(taught(rich(99)));
  const ViewQuality twice = assess_view(view, {same}, sift());
  EXPECT_GT(twice.redundancy, 0.9);
  EXPECT_THAT(twice.advice, Contains(HasSubstr("adds little")));
  EXPECT_LT(assess_view(view, {other}, sift()).redundancy, 0.3);
}

TEST(AssessView, TakesTheHalfFloatsOfLoadedViews) {
  const View view = taught(rich());
  View loaded = view;
  loaded.features.descriptors = cv::Mat();
  view.features.descriptors.convertTo(loaded.features.descriptors, CV_16F);
  const ViewQuality quality = assess_view(loaded, {std::make_shared<View>(loaded)}, sift());
  EXPECT_EQ(quality.smallest_size_px, assess_view(view, {}, sift()).smallest_size_px);
  EXPECT_GT(quality.redundancy, 0.9);
}

TEST(AssessView, SkipsItselfAndViewsOfOtherFeatures) {
  const auto view = std::make_shared<View>(taught(rich()));
  auto strange = std::make_shared<View>(*view);
  strange->features.descriptors = view->features.descriptors.colRange(0, 64).clone();
  EXPECT_EQ(assess_view(*view, {view, strange, nullptr}, sift()).redundancy, 0);
}

TEST(AssessView, NamesTheBorderThatCutsTheObject) {
  View view = taught(rich());
  view.mask = cv::Mat::zeros(view.mask.size(), CV_8U);
  view.mask(cv::Rect(0, 50, 200, 200)) = 255;
  EXPECT_THAT(assess_view(view, {}, sift()).advice, Contains(HasSubstr("cut by the left border")));
}

TEST(AssessView, LeavesUnknownWhatNeedsThePicture) {
  View view = taught(rich());
  view.picture.release();
  const ViewQuality quality = assess_view(view, {}, sift());
  EXPECT_TRUE(std::isnan(quality.smallest_size_px));
  EXPECT_TRUE(std::isnan(quality.self_similarity));
  EXPECT_GT(quality.coverage, 0);
}

TEST(AssessView, AnswersForAViewWithoutFeatures) {
  View view = taught(rich());
  view.features = {};
  const ViewQuality quality = assess_view(view, {}, sift());
  EXPECT_EQ(quality.features, 0U);
  EXPECT_EQ(quality.coverage, 0);
  EXPECT_THAT(quality.advice, Contains(HasSubstr("Only 0 features")));
  EXPECT_NO_THROW((void)assess_view(View(), {}, sift()));
}

TEST(AssessView, AdvisesTheNextYaw) {
  const View front = taught(rich(), 0);
  const auto side = std::make_shared<View>(taught(rich(3), 90));
  const ViewQuality quality = assess_view(front, {side}, sift());
  EXPECT_EQ(quality.next_yaw_deg, 90 + 30);
  EXPECT_THAT(quality.advice, Contains(HasSubstr("120 degrees")));
  EXPECT_THAT(assess_view(taught(rich()), {}, sift()).advice, Not(Contains(HasSubstr("degrees"))));
}

TEST(NextYaw, StepsIntoTheLargestGap) {
  EXPECT_EQ(next_yaw({}, 30), 0);
  EXPECT_EQ(next_yaw({std::nan("")}, 30), 0);
  EXPECT_NEAR(next_yaw({0}, 30), 30, 1e-9);
  EXPECT_NEAR(next_yaw({-30, 0, 30}, 30), 60, 1e-9);
  EXPECT_NEAR(next_yaw({0, 40, 70, 100, 130, 160, 190, 220, 250, 280, 310, 340}, 30), 20, 1e-9);
  EXPECT_NEAR(next_yaw({350, 20, 50}, 30), 80, 1e-9);
}

TEST(NextYaw, IsSatisfiedByAFullCircle) {
  std::vector<double> circle;
  for (int yaw = 0; yaw < 360; yaw += 30) circle.push_back(yaw);
  EXPECT_TRUE(std::isnan(next_yaw(circle, 30)));
  circle.pop_back();
  EXPECT_NEAR(next_yaw(circle, 30), 330, 1e-9);
}

}  // namespace
}  // namespace posevote
