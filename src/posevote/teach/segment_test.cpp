#include "posevote/teach/segment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "posevote/core/error.hpp"
#include "posevote/teach/made_pictures.hpp"

namespace posevote {
namespace {

using ::testing::HasSubstr;

void expect_refused(const cv::Mat& picture, const cv::Mat& background, ErrorCode code,
                    const std::string& advice) {
  try {
    (void)segment_by_background(picture, background);
    FAIL() << "not refused; expected: " << advice;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_THAT(error.what(), HasSubstr(advice));
  }
}

TEST(SegmentByBackground, FindsABoxOnTexturedGround) {
  const auto s = made::scene();
  EXPECT_GT(made::iou(segment_by_background(s.picture, s.background), s.truth), 0.97);
}

TEST(SegmentByBackground, FindsABoxOnPlainGround) {
  const auto s = made::scene(cv::Rect(120, 70, 80, 100), 0);
  EXPECT_GT(made::iou(segment_by_background(s.picture, s.background), s.truth), 0.97);
}

TEST(SegmentByBackground, GivesAMaskOfTheGivenSizeWithTwoValues) {
  const auto s = made::scene();
  const cv::Mat mask = segment_by_background(s.picture, s.background);
  EXPECT_EQ(mask.type(), CV_8U);
  EXPECT_EQ(mask.size(), s.picture.size());
  EXPECT_EQ(cv::countNonZero(mask), cv::countNonZero(mask == 255));
}

TEST(SegmentByBackground, LeavesOutTheShadowOnTexturedGround) {
  auto s = made::scene();
  cv::Mat shaded = s.picture.clone();
  made::cast_shadow(shaded, {225, 165}, {60, 22}, 0.4);
  s.picture.copyTo(shaded, s.truth);
  const cv::Mat mask = segment_by_background(shaded, s.background);
  EXPECT_GT(made::iou(mask, s.truth), 0.95);
  EXPECT_LT(cv::countNonZero(mask & ~s.truth), 0.05 * cv::countNonZero(s.truth));
}

TEST(SegmentByBackground, LeavesOutADeepShadowOnPlainGround) {
  auto s = made::scene(cv::Rect(120, 70, 80, 100), 0);
  cv::Mat shaded = s.picture.clone();
  made::cast_shadow(shaded, {225, 165}, {60, 22}, 0.3);
  s.picture.copyTo(shaded, s.truth);
  const cv::Mat mask = segment_by_background(shaded, s.background);
  EXPECT_LT(cv::countNonZero(mask & ~s.truth), 0.05 * cv::countNonZero(s.truth));
  EXPECT_GT(made::iou(mask, s.truth), 0.95);
}

// Near black the colour is the camera's: its offset and JPEG, not the ground's.
TEST(SegmentByBackground, LeavesOutABlackShadowOfAnotherTintOnDarkGround) {
  auto s = made::scene(cv::Rect(120, 70, 80, 100), 0);
  s.background = s.background * 0.15;
  cv::Mat shaded = s.picture * 0.15;
  made::cast_shadow(shaded, {225, 165}, {60, 22}, 0.1);
  cv::Mat black;
  cv::cvtColor(shaded, black, cv::COLOR_BGR2GRAY);
  shaded.setTo(cv::Scalar(4, 1, 2), black < 6);
  s.picture.copyTo(shaded, s.truth);
  const cv::Mat mask = segment_by_background(shaded, s.background);
  EXPECT_LT(cv::countNonZero(mask & ~s.truth), 0.05 * cv::countNonZero(s.truth));
  EXPECT_GT(made::iou(mask, s.truth), 0.95);
}

// As dark as a shadow and of the ground's colour, but without the ground's texture.
TEST(SegmentByBackground, KeepsAPlainObjectOfTheColourOfAShadow) {
  auto s = made::scene();
  s.picture.setTo(cv::Scalar(66, 78, 90), s.truth);
  made::add_noise(s.picture, 2, 5);
  EXPECT_GT(made::iou(segment_by_background(s.picture, s.background), s.truth), 0.95);
}

class SegmentOtherCamera : public ::testing::TestWithParam<std::array<double, 4>> {};

TEST_P(SegmentOtherCamera, BearsAnotherExposureAndWhiteBalance) {
  const auto [blue, green, red, offset] = GetParam();
  const auto s = made::scene();
  cv::Mat other;
  cv::multiply(s.picture, cv::Scalar(blue, green, red), other);
  other += cv::Scalar::all(offset);
  EXPECT_GT(made::iou(segment_by_background(other, s.background), s.truth), 0.95);
}

INSTANTIATE_TEST_SUITE_P(GainsAndOffset, SegmentOtherCamera,
                         ::testing::Values(std::array{0.7, 0.7, 0.7, 0.0},
                                           std::array{1.3, 1.3, 1.3, 0.0},
                                           std::array{1.2, 1.0, 0.8, 0.0},
                                           std::array{0.8, 1.0, 1.15, 0.0},
                                           std::array{1.0, 1.0, 1.0, 12.0}));

TEST(SegmentByBackground, BearsACameraThatShookALittle) {
  const auto s = made::scene();
  const cv::Mat warp = (cv::Mat_<double>(2, 3) << 1, 0, 1.6, 0, 1, -1.2);
  cv::Mat background;
  cv::warpAffine(s.background, background, warp, s.background.size(), cv::INTER_CUBIC,
                 cv::BORDER_REFLECT);
  EXPECT_GT(made::iou(segment_by_background(s.picture, background), s.truth), 0.95);
}

TEST(SegmentByBackground, FillsAHoleThatOnlyLooksLikeShade) {
  auto s = made::scene(cv::Rect(120, 70, 80, 100), 0);
  s.picture(cv::Rect(145, 105, 30, 30)) = cv::Scalar(77, 91, 105);
  const cv::Mat mask = segment_by_background(s.picture, s.background);
  EXPECT_EQ(cv::countNonZero(mask(cv::Rect(147, 107, 26, 26))), 26 * 26);
}

TEST(SegmentByBackground, SeesTheGroundThroughAHandle) {
  auto s = made::scene();
  const cv::Rect handle(140, 90, 40, 50);
  s.background(handle).copyTo(s.picture(handle));
  s.truth(handle) = 0;
  EXPECT_GT(made::iou(segment_by_background(s.picture, s.background), s.truth), 0.93);
}

TEST(SegmentByBackground, KeepsTwoPartsOfOneObject) {
  auto s = made::scene(cv::Rect(90, 80, 60, 80));
  const cv::Rect second(190, 90, 40, 60);
  made::box_art(second.size(), 9).copyTo(s.picture(second));
  s.truth(second) = 255;
  EXPECT_GT(made::iou(segment_by_background(s.picture, s.background), s.truth), 0.95);
}

TEST(SegmentByBackground, LeavesOutSpecksAndThingsAtTheBorder) {
  auto s = made::scene();
  s.picture(cv::Rect(40, 40, 6, 6)) = cv::Scalar(250, 20, 20);
  made::box_art({40, 60}, 3).copyTo(s.picture(cv::Rect(280, 0, 40, 60)));
  EXPECT_GT(made::iou(segment_by_background(s.picture, s.background), s.truth), 0.97);
}

TEST(SegmentByBackground, TakesGrey16BitAndBgra) {
  const auto s = made::scene();
  cv::Mat picture, background;
  cv::cvtColor(s.picture, picture, cv::COLOR_BGR2GRAY);
  cv::cvtColor(s.background, background, cv::COLOR_BGR2GRAY);
  EXPECT_GT(made::iou(segment_by_background(picture, background), s.truth), 0.9);
  cv::cvtColor(s.picture, picture, cv::COLOR_BGR2BGRA);
  EXPECT_GT(made::iou(segment_by_background(picture, s.background), s.truth), 0.97);
  s.picture.convertTo(picture, CV_16U, 256);
  s.background.convertTo(background, CV_16U, 256);
  EXPECT_GT(made::iou(segment_by_background(picture, background), s.truth), 0.97);
}

TEST(SegmentByBackground, SegmentsLargePicturesAsSmallOnes) {
  const auto s = made::scene();
  cv::Mat picture, background, truth;
  cv::resize(s.picture, picture, {1600, 1200}, 0, 0, cv::INTER_CUBIC);
  cv::resize(s.background, background, {1600, 1200}, 0, 0, cv::INTER_CUBIC);
  cv::resize(s.truth, truth, {1600, 1200}, 0, 0, cv::INTER_NEAREST);
  EXPECT_GT(made::iou(segment_by_background(picture, background), truth), 0.97);
}

TEST(SegmentByBackground, IsDeterministic) {
  const auto s = made::scene();
  const cv::Mat a = segment_by_background(s.picture, s.background);
  const cv::Mat b = segment_by_background(s.picture, s.background);
  EXPECT_EQ(cv::norm(a, b, cv::NORM_INF), 0);
}

TEST(SegmentByBackground, RefusesTheBackgroundItself) {
  auto s = made::scene();
  expect_refused(s.background, s.background, ErrorCode::unusable_view, "nothing in the picture");
  cv::Mat again = made::ground({320, 240});
  made::add_noise(again, 2, 99);
  expect_refused(again, s.background, ErrorCode::unusable_view, "nothing in the picture");
}

TEST(SegmentByBackground, RefusesAShadowAlone) {
  auto s = made::scene();
  cv::Mat picture = s.background.clone();
  made::cast_shadow(picture, {160, 120}, {60, 30}, 0.5);
  expect_refused(picture, s.background, ErrorCode::unusable_view, "nothing in the picture");
}

TEST(SegmentByBackground, RefusesAnObjectThatReachesAllSides) {
  const auto s = made::scene(cv::Rect(0, 100, 320, 40), 0);
  cv::Mat picture = s.picture.clone();
  made::box_art({40, 240}, 4).copyTo(picture(cv::Rect(140, 0, 40, 240)));
  expect_refused(picture, s.background, ErrorCode::unusable_view, "all four sides");
}

TEST(SegmentByBackground, RefusesAnObjectThatCoversNearlyEverything) {
  for (const double contrast : {0, 25}) {
    const auto s = made::scene(cv::Rect(3, 3, 314, 234), contrast);
    EXPECT_THROW((void)segment_by_background(s.picture, s.background), Error);
  }
}

TEST(SegmentByBackground, RefusesAnotherLight) {
  const auto s = made::scene();
  cv::Mat picture;
  cv::multiply(s.picture, cv::Scalar(0.4, 0.8, 1.2), picture);
  expect_refused(picture, s.background, ErrorCode::unusable_view, "another brightness or colour");
}

TEST(SegmentByBackground, RefusesAnotherScene) {
  const auto s = made::scene();
  cv::Mat other = made::ground({320, 240}, 25, 77);
  made::add_noise(other, 2, 13);
  expect_refused(s.picture, other, ErrorCode::unusable_view, "camera has moved");
}

TEST(SegmentByBackground, RefusesOtherSizesAndTypes) {
  const auto s = made::scene();
  expect_refused(s.picture, s.background(cv::Rect(0, 0, 319, 240)), ErrorCode::invalid_argument,
                 "319 x 240");
  expect_refused(cv::Mat(), s.background, ErrorCode::invalid_argument, "empty");
  expect_refused(s.picture, cv::Mat(), ErrorCode::invalid_argument, "empty");
  cv::Mat wrong;
  s.picture.convertTo(wrong, CV_32F);
  expect_refused(wrong, s.background, ErrorCode::invalid_argument, "8 or 16 bits");
}

TEST(SegmentByBackground, AnswersForTinyPicturesToo) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(2, 1), cv::Size(3, 7), cv::Size(16, 16)}) {
    const cv::Mat background(size, CV_8UC3, cv::Scalar::all(90));
    expect_refused(background, background, ErrorCode::unusable_view, "nothing in the picture");
    EXPECT_THROW((void)segment_by_background(background * 2, cv::Mat::zeros(size, CV_8UC3)), Error);
  }
}

TEST(ToBgr8, ConvertsEveryTypeAndRefusesOthers) {
  EXPECT_EQ(to_bgr8(cv::Mat(2, 3, CV_8U, cv::Scalar(7))).at<cv::Vec3b>(0, 0), cv::Vec3b(7, 7, 7));
  EXPECT_EQ(to_bgr8(cv::Mat(2, 3, CV_16UC3, cv::Scalar(256, 512, 65535))).at<cv::Vec3b>(0, 0),
            cv::Vec3b(1, 2, 255));
  EXPECT_EQ(to_bgr8(cv::Mat(2, 3, CV_8UC4, cv::Scalar(1, 2, 3, 0))).at<cv::Vec3b>(0, 0),
            cv::Vec3b(1, 2, 3));
  EXPECT_THROW((void)to_bgr8(cv::Mat(2, 3, CV_8UC2)), Error);
  EXPECT_THROW((void)to_bgr8(cv::Mat()), Error);
}

// Rendered views with real shadows and their true masks.
class SegmentDemo : public ::testing::TestWithParam<const char*> {};

TEST_P(SegmentDemo, AgreesWithTheTrueMask) {
  const std::string demo = std::string(POSEVOTE_SOURCE_DIR) + "/data/demo/";
  const std::string object = GetParam();
  const std::string name = object.substr(0, object.find('/'));
  const cv::Mat picture = cv::imread(demo + "train/" + object + ".jpg");
  const cv::Mat background = cv::imread(demo + "train/" + name + "/background.jpg");
  const cv::Mat truth = cv::imread(demo + "masks/" + object + ".png", cv::IMREAD_GRAYSCALE) > 127;
  ASSERT_FALSE(picture.empty() || background.empty() || truth.empty());
  const cv::Mat mask = segment_by_background(picture, background);
  EXPECT_GT(made::iou(mask, truth), 0.93);
  EXPECT_LT(cv::countNonZero(mask & ~truth), 0.05 * cv::countNonZero(truth));
}

INSTANTIATE_TEST_SUITE_P(Views, SegmentDemo,
                         ::testing::Values("muesli/y000", "muesli/y072", "tea-mint/y000",
                                           "tea-cherry/y180", "soup/y000", "book/y036", "mug/y120",
                                           "juice/y090"));

}  // namespace
}  // namespace posevote
