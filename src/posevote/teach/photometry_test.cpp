#include "posevote/teach/photometry.hpp"

#include <gtest/gtest.h>

#include "posevote/teach/made_pictures.hpp"

namespace posevote {
namespace {

cv::Mat levels(const cv::Mat& picture) {
  cv::Mat result;
  picture.convertTo(result, CV_32FC3);
  return result;
}

cv::Mat changed(const cv::Mat& picture, const cv::Scalar& gain, double offset) {
  cv::Mat result;
  cv::multiply(levels(picture), gain, result);
  return result + cv::Scalar::all(offset);
}

TEST(FitBackground, FindsGainAndOffsetDespiteObjectAndShadow) {
  auto s = made::scene();
  made::cast_shadow(s.picture, {225, 165}, {60, 22}, 0.4);
  const auto fit = fit_background(changed(s.picture, {0.8, 1.0, 1.2}, 6), levels(s.background));
  const std::array wanted{0.8, 1.0, 1.2};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(fit.gain[c], wanted[c], 0.03);
    EXPECT_NEAR(fit.offset[c], 6, 4);
  }
  const cv::Mat frame = border_frame(s.picture.size(), 0.1);
  const cv::Scalar left = cv::mean(changed(s.picture, {0.8, 1.0, 1.2}, 6) - fit.expected, frame);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(left[c], 0, 0.7);
}

TEST(FitBackground, StandsAnObjectThatCoversHalfOfThePicture) {
  const auto s = made::scene(cv::Rect(40, 25, 240, 190));
  const auto fit = fit_background(levels(s.picture), levels(s.background));
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(fit.gain[c], 1, 0.03);
}

TEST(FitBackground, DoesNotGuessAnOffsetFromOneBrightness) {
  const cv::Mat background(60, 80, CV_32FC3, cv::Scalar::all(100));
  const auto fit = fit_background(background * 1.1, background);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(fit.gain[c], 1.1, 0.02);
    EXPECT_NEAR(fit.offset[c], 0, 1);
  }
  EXPECT_EQ(fit.shift, cv::Point2d());
  EXPECT_EQ(fit.texture_agreement, 1);
}

TEST(FitBackground, FindsASmallShift) {
  const auto s = made::scene();
  const cv::Mat warp = (cv::Mat_<double>(2, 3) << 1, 0, 1.5, 0, 1, -0.75);
  cv::Mat moved;
  cv::warpAffine(levels(s.picture), moved, warp, s.picture.size(), cv::INTER_CUBIC,
                 cv::BORDER_REFLECT);
  const auto fit = fit_background(moved, levels(s.background));
  EXPECT_NEAR(fit.shift.x, 1.5, 0.1);
  EXPECT_NEAR(fit.shift.y, -0.75, 0.1);
}

TEST(FitBackground, MeasuresTheNoise) {
  for (const double sigma : {1.0, 3.0, 6.0}) {
    cv::Mat background = made::ground({320, 240}, 0), picture = background.clone();
    made::add_noise(background, sigma, 1);
    made::add_noise(picture, sigma, 2);
    const auto noise = fit_background(levels(picture), levels(background)).noise;
    // The ground's blue, green and red are 110, 130 and 150; two noises add up.
    EXPECT_NEAR(noise.sigma[0][7], std::sqrt(2.0) * sigma, 0.25 * sigma);
    EXPECT_NEAR(noise.sigma[1][8], std::sqrt(2.0) * sigma, 0.25 * sigma);
    EXPECT_NEAR(noise.sigma[2][9], std::sqrt(2.0) * sigma, 0.25 * sigma);
  }
}

TEST(FitBackground, TellsOneSceneFromAnother) {
  const auto s = made::scene();
  EXPECT_GT(fit_background(levels(s.picture), levels(s.background)).texture_agreement, 0.9);
  const cv::Mat other = levels(made::ground({320, 240}, 25, 77));
  EXPECT_LT(fit_background(levels(s.picture), other).texture_agreement, 0.3);
}

TEST(FitBackground, AnswersForTinyAndBlackPictures) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(1, 40), cv::Size(40, 3)}) {
    const cv::Mat black = cv::Mat::zeros(size, CV_32FC3);
    const auto fit = fit_background(black, black);
    EXPECT_EQ(fit.expected.size(), size);
    EXPECT_TRUE(cv::checkRange(fit.expected));
    EXPECT_TRUE(cv::checkRange(fit.noise.variance(fit.expected)));
  }
}

TEST(NoiseModel, InterpolatesBetweenLevelsAndAddsTheJitterOfEdges) {
  NoiseModel noise;
  for (auto& channel : noise.sigma) channel.fill(2);
  noise.sigma[1][5] = 4;
  cv::Mat flat(20, 20, CV_32FC3, cv::Scalar(72, 72, 72));
  const auto at = noise.variance(flat).at<cv::Vec3f>(10, 10);
  EXPECT_FLOAT_EQ(at[0], 4);
  EXPECT_FLOAT_EQ(at[1], 9);
  noise.jitter_px = 0.5;
  cv::Mat ramp(20, 20, CV_32FC3);
  for (int x = 0; x < 20; ++x) ramp.col(x) = cv::Scalar::all(8 * x);
  EXPECT_NEAR(noise.variance(ramp).at<cv::Vec3f>(10, 5)[0], 4 + 0.25 * 64, 1e-3);
}

TEST(BorderFrame, IsAtLeastAPixelWide) {
  EXPECT_EQ(cv::countNonZero(border_frame({100, 50}, 0.1)), 100 * 50 - 90 * 40);
  EXPECT_EQ(cv::countNonZero(border_frame({10, 10}, 0.001)), 36);
  EXPECT_EQ(cv::countNonZero(border_frame({1, 1}, 0.1)), 1);
}

}  // namespace
}  // namespace posevote
