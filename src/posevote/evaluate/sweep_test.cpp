#include "posevote/evaluate/sweep.hpp"

#include <gtest/gtest.h>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/made_dataset.hpp"

namespace posevote {
namespace {

cv::Mat changed(const std::string& sweep, double level, std::uint64_t seed = 1) {
  DatasetTest test;
  test.objects.resize(1);
  test.objects[0].box = {20, 20, 100, 100};
  return disturb(draw_cover(1), sweep, level, test, seed).picture;
}

double difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_INF);
}

TEST(Disturb, AtItsMildestLevelChangesNothing) {
  const cv::Mat cover = draw_cover(1);
  for (const char* sweep : {"noise", "blur", "light", "rotation", "occlusion"})
    EXPECT_EQ(difference(changed(sweep, 0), cover), 0) << sweep;
  EXPECT_EQ(difference(changed("scale", 1), cover), 0);
}

TEST(Disturb, IsTheSameForTheSameSeedOnly) {
  EXPECT_EQ(difference(changed("noise", 10, 5), changed("noise", 10, 5)), 0);
  EXPECT_GT(difference(changed("noise", 10, 5), changed("noise", 10, 6)), 0);
}

TEST(Disturb, NoiseHasTheStandardDeviationAskedFor) {
  const cv::Mat grey(200, 200, CV_8U, cv::Scalar(128));
  cv::Mat mean, deviation;
  cv::meanStdDev(disturb(grey, "noise", 10, {}, 1).picture, mean, deviation);
  EXPECT_NEAR(deviation.at<double>(0), 10, 0.3);
}

TEST(Disturb, LightFallsFromLeftToRight) {
  const cv::Mat white(4, 101, CV_8U, cv::Scalar(200));
  const cv::Mat lit = disturb(white, "light", 0.8, {}, 1).picture;
  EXPECT_EQ(lit.at<uchar>(0, 0), 200);
  EXPECT_NEAR(lit.at<uchar>(0, 50), 120, 1);
  EXPECT_NEAR(lit.at<uchar>(0, 100), 40, 1);
}

TEST(Disturb, OcclusionCoversTheShareOfTheBoxAndNothingOutside) {
  const cv::Mat covered = changed("occlusion", 50) != draw_cover(1);
  cv::Mat any;
  cv::reduce(covered.reshape(1, static_cast<int>(covered.total())), any, 1, cv::REDUCE_MAX);
  any = any.reshape(1, covered.rows);
  EXPECT_NEAR(cv::countNonZero(any(cv::Rect(20, 20, 100, 100))), 5000, 150);
  EXPECT_LE(cv::countNonZero(any), 5100);
}

TEST(Disturb, GeometryTakesPointsWhereItSays) {
  cv::Mat dot(101, 151, CV_8U, cv::Scalar(0));
  cv::circle(dot, {40, 30}, 6, cv::Scalar(255), cv::FILLED);
  for (const auto& [sweep, level] : {std::pair("rotation", 30.0), std::pair("rotation", 90.0),
                                     std::pair("scale", 0.5), std::pair("scale", 2.83)}) {
    const DisturbedPicture result = disturb(dot, sweep, level, {}, 1);
    cv::Mat bright;
    cv::inRange(result.picture, 200, 255, bright);
    const cv::Moments moments = cv::moments(bright, true);
    const cv::Vec2d expected = result.from_original * cv::Vec3d(40, 30, 1);
    EXPECT_NEAR(moments.m10 / moments.m00, expected[0], 0.6) << sweep << level;
    EXPECT_NEAR(moments.m01 / moments.m00, expected[1], 0.6) << sweep << level;
  }
}

TEST(Disturb, TakesSixteenBitsAndAlpha) {
  const cv::Mat deep(20, 20, CV_16UC4, cv::Scalar::all(32768));
  for (const std::string& sweep : sweep_names()) {
    const double level = sweep == "jpeg" ? 50 : 0.5;
    EXPECT_EQ(disturb(deep, sweep, level, {}, 1).picture.depth(), CV_8U) << sweep;
  }
}

TEST(SweepLevels, OfAnUnknownNameIsAnError) {
  EXPECT_THROW(static_cast<void>(sweep_levels("rain")), Error);
}

TEST(RunSweep, ScoresTurnedPicturesInTheOriginalFrame) {
  MadeDataset made(1);
  made.add_test("g", 0);
  made.add_test("nothing", -1);
  const Dataset dataset = load_dataset(made.folder());
  const Method method = make_method("default", {});
  const ReportSection section =
      run_sweep("rotation", dataset, TaughtMethod(dataset, method), method);
  ASSERT_EQ(section.tables[0].rows.size(), sweep_levels("rotation").levels.size());
  for (const auto& row : section.tables[0].rows) {
    EXPECT_EQ(row[1], "1") << row[0];
    EXPECT_EQ(row[2], "1") << row[0];
  }
}

}  // namespace
}  // namespace posevote
