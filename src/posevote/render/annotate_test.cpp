#include "posevote/render/annotate.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

RecognitionResult made_result() {
  RecognitionResult result;
  Detection detection;
  detection.object = "Müsli";
  detection.confidence = 0.5;
  detection.outline = {{100, 100}, {200, 100}, {200, 200}, {100, 200}};
  detection.box = {100, 100, 100, 100};
  detection.matches = {{{1, 1}, {150, 150}}};
  result.detections.push_back(detection);
  return result;
}

cv::Mat grey_picture() {
  return {240, 320, CV_8UC3, cv::Scalar::all(128)};
}

int changed(const cv::Mat& image, const cv::Rect& area) {
  cv::Mat difference;
  cv::absdiff(image, grey_picture(), difference);
  cv::Mat grey;
  cv::cvtColor(difference, grey, cv::COLOR_BGR2GRAY);
  return cv::countNonZero(grey(area));
}

TEST(Annotate, NothingFoundLeavesThePictureAsItIs) {
  EXPECT_EQ(changed(annotate(grey_picture(), {}), {0, 0, 320, 240}), 0);
}

TEST(Annotate, OutlineTintLabelAndPointsAreDrawnWhereTheObjectIs) {
  const cv::Mat image = annotate(grey_picture(), made_result());
  const cv::Scalar color = object_color("Müsli");
  const auto& at_point = image.at<cv::Vec3b>(150, 150);
  const auto& at_line = image.at<cv::Vec3b>(150, 100);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(at_point[c], color[c], 2);
    EXPECT_NEAR(at_line[c], color[c], 30);
  }
  EXPECT_EQ(changed(image, {110, 110, 30, 30}), 900) << "tint";
  EXPECT_GT(changed(image, {100, 88, 60, 12}), 600) << "label";
  EXPECT_EQ(changed(image, {0, 210, 320, 30}), 0);
}

TEST(Annotate, TheLabelTellsTheProbabilityAndEq11OnlyWhereThereIsNone) {
  const auto drawn = [](double probability, double confidence) {
    RecognitionResult result = made_result();
    result.detections[0].probability = probability;
    result.detections[0].confidence = confidence;
    return annotate(grey_picture(), result);
  };
  const auto same = [](const cv::Mat& a, const cv::Mat& b) {
    return cv::norm(a, b, cv::NORM_INF) == 0;
  };
  EXPECT_TRUE(same(drawn(0.9, 0.3), drawn(0.9, 0.5)));
  EXPECT_FALSE(same(drawn(0.9, 0.3), drawn(0.8, 0.3)));
  EXPECT_TRUE(same(drawn(0, 0.3), drawn(0.3, 0.5)));
  EXPECT_TRUE(same(drawn(0.9999, 0.3), drawn(0.996, 0.3))) << "never 100 %";
}

TEST(Annotate, TintAndPointsCanBeLeftOut) {
  AnnotateOptions options;
  options.fill = options.points = false;
  EXPECT_EQ(changed(annotate(grey_picture(), made_result(), options), {110, 110, 80, 80}), 0);
}

TEST(Annotate, WithoutAFontThePlainLettersDo) {
  AnnotateOptions options;
  options.font = "/nowhere";
  EXPECT_GT(changed(annotate(grey_picture(), made_result(), options), {100, 88, 60, 12}), 600);
}

TEST(Annotate, EveryKindOfPictureBecomesBgr) {
  for (const int type : {CV_8UC1, CV_8UC4, CV_16UC1, CV_16UC3, CV_16UC4}) {
    const cv::Mat image(240, 320, type,
                        cv::Scalar::all(CV_MAT_DEPTH(type) == CV_16U ? 32768 : 128));
    const cv::Mat annotated = annotate(image, made_result());
    EXPECT_EQ(annotated.type(), CV_8UC3);
    EXPECT_EQ(changed(annotated, {0, 210, 320, 30}), 0);
  }
}

TEST(Annotate, SenselessPlacesAndTinyPicturesDoNoHarm) {
  RecognitionResult result = made_result();
  const float infinite = std::numeric_limits<float>::infinity();
  result.detections[0].outline = {
      {-1e30F, 5}, {1e30F, 8}, {infinite, -infinite}, {0, std::nanf("")}};
  result.detections[0].box = {-1e30, std::nan(""), 1e31, 2e31};
  result.detections[0].matches[0].scene = {infinite, 3};
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(1, 100), cv::Size(640, 3)})
    EXPECT_EQ(annotate(cv::Mat(size, CV_8UC3, cv::Scalar()), result).size(), size);
  EXPECT_TRUE(annotate(cv::Mat(), result).empty());
}

TEST(Annotate, AColorBelongsToAName) {
  EXPECT_EQ(object_color("mug"), object_color("mug"));
  EXPECT_NE(object_color("tea-mint"), object_color("tea-cherry"));
}

TEST(Annotate, TheGivenPictureIsNotTouched) {
  const cv::Mat image = grey_picture();
  static_cast<void>(annotate(image, made_result()));
  EXPECT_EQ(changed(image, {0, 0, 320, 240}), 0);
}

}  // namespace
}  // namespace posevote
