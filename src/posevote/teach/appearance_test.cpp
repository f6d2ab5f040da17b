#include "posevote/teach/appearance.hpp"

#include <gtest/gtest.h>

#include "posevote/teach/made_pictures.hpp"

namespace posevote {
namespace {

constexpr double kAnyColour = 1.0 / (256.0 * 256 * 256);

cv::Mat filled(cv::Vec3f colour) {
  return cv::Mat(40, 40, CV_32FC3, cv::Scalar(colour[0], colour[1], colour[2]));
}

const cv::Vec3f kGround(110, 130, 150);

// Evidence for the background at the middle of a plain picture.
float log_likelihood_of(const cv::Vec3f& colour) {
  const cv::Mat picture = filled(colour), expected = filled(kGround), variance = filled({4, 4, 4});
  const cv::Mat everywhere(picture.size(), CV_32F, cv::Scalar(1));
  const ShadowOptions options;
  const cv::Mat shading = estimate_shading(picture, expected, variance, everywhere, options);
  return background_log_likelihood(picture, expected, variance, shading, options).at<float>(20, 20);
}

TEST(EstimateShading, MeasuresTheDepthOfAShadow) {
  const cv::Mat everywhere(40, 40, CV_32F, cv::Scalar(1));
  for (const float s : {0.2F, 0.6F, 1.0F}) {
    const cv::Mat shading =
        estimate_shading(filled(kGround * s), filled(kGround), filled({4, 4, 4}), everywhere, {});
    EXPECT_NEAR(shading.at<float>(20, 20), s, 0.001);
  }
}

TEST(EstimateShading, LooksOnlyWhereTheBackgroundIs) {
  cv::Mat picture = filled(kGround * 0.5);
  cv::Mat weight(40, 40, CV_32F, cv::Scalar(1));
  picture(cv::Rect(15, 15, 10, 10)) = cv::Scalar(250, 0, 250);
  weight(cv::Rect(15, 15, 10, 10)) = 0;
  const cv::Mat shading = estimate_shading(picture, filled(kGround), filled({4, 4, 4}), weight, {});
  EXPECT_NEAR(shading.at<float>(20, 20), 0.5, 0.001);
}

TEST(EstimateShading, IsOneWhereNothingIsKnown) {
  const cv::Mat nowhere = cv::Mat::zeros(40, 40, CV_32F);
  const cv::Mat shading =
      estimate_shading(filled({9, 9, 9}), filled(kGround), filled({4, 4, 4}), nowhere, {});
  EXPECT_FLOAT_EQ(shading.at<float>(20, 20), 1);
}

TEST(BackgroundLogLikelihood, OrdersLitShadedAndForeignColours) {
  const float lit = log_likelihood_of(kGround);
  const float shaded = log_likelihood_of(kGround * 0.5);
  EXPECT_GT(lit, shaded);
  EXPECT_GT(shaded, std::log(kAnyColour) + 3);
  // Of the same brightness as the shadow, but blue for red; brighter; darker than any shadow.
  EXPECT_LT(log_likelihood_of({75, 65, 55}), shaded - 5);
  EXPECT_LT(log_likelihood_of(kGround * 1.4), shaded - 5);
  EXPECT_LT(log_likelihood_of(kGround * 0.02), shaded - 2);
}

TEST(BackgroundLogLikelihood, KeepsTheEvidenceOfOnePixelBounded) {
  EXPECT_NEAR(log_likelihood_of({255, 0, 0}), std::log(1e-3 * kAnyColour), 0.01);
}

TEST(BackgroundLogLikelihood, WantsTheBackgroundsTextureInItsShadow) {
  cv::Mat ground, plain;
  made::ground({40, 40}).convertTo(ground, CV_32FC3);
  plain = cv::Mat(40, 40, CV_32FC3, cv::mean(ground) * 0.6);
  const cv::Mat variance = filled({4, 4, 4}), everywhere(40, 40, CV_32F, cv::Scalar(1));
  const ShadowOptions options;
  const auto mean_advantage = [&](const cv::Mat& picture) {
    const cv::Mat shading = estimate_shading(picture, ground, variance, everywhere, options);
    return cv::mean(background_log_likelihood(picture, ground, variance, shading, options) -
                    plain_log_likelihood(picture, variance, options))[0];
  };
  EXPECT_GT(mean_advantage(ground * 0.6), 0.5);
  EXPECT_LT(mean_advantage(plain), -0.5);
}

TEST(PlainLogLikelihood, EqualsTheShadowsOnAPlainBackground) {
  const cv::Mat picture = filled(kGround * 0.5), expected = filled(kGround);
  const cv::Mat variance = filled({4, 4, 4}), everywhere(40, 40, CV_32F, cv::Scalar(1));
  const ShadowOptions options;
  const cv::Mat shading = estimate_shading(picture, expected, variance, everywhere, options);
  const cv::Mat shadow =
      background_log_likelihood(picture, expected, variance, shading, options) + std::log(2.0);
  const cv::Mat plain = plain_log_likelihood(picture, variance, options);
  EXPECT_NEAR(shadow.at<float>(20, 20), plain.at<float>(20, 20), 1);
}

TEST(ObjectColours, KnowsNoColourAtFirst) {
  EXPECT_NEAR(ObjectColours().log_likelihood(filled(kGround)).at<float>(3, 3), std::log(kAnyColour),
              1e-4);
  const ObjectColours nothing(filled(kGround), cv::Mat::zeros(40, 40, CV_8U));
  EXPECT_NEAR(nothing.log_likelihood(filled({1, 2, 3})).at<float>(3, 3), std::log(kAnyColour),
              1e-4);
}

TEST(ObjectColours, PrefersWhatItHasSeen) {
  cv::Mat picture = filled({20, 200, 90});
  cv::Mat sure(40, 40, CV_8U, cv::Scalar(255));
  picture(cv::Rect(0, 0, 20, 40)) = cv::Scalar(255, 255, 255);
  const ObjectColours colours(picture, sure);
  const auto at = [&](const cv::Vec3f& c) {
    return colours.log_likelihood(filled(c)).at<float>(3, 3);
  };
  EXPECT_GT(at({20, 200, 90}), std::log(kAnyColour) + 5);
  EXPECT_GT(at({255, 255, 255}), std::log(kAnyColour) + 5);
  EXPECT_GT(at({22, 196, 94}), std::log(kAnyColour) + 4);
  EXPECT_NEAR(at({20, 20, 200}), std::log(0.2 * kAnyColour), 1e-3);
}

TEST(ObjectColours, IsADensity) {
  const cv::Mat picture = [] {
    cv::Mat p;
    made::box_art({40, 40}).convertTo(p, CV_32FC3);
    return p;
  }();
  const ObjectColours colours(picture, cv::Mat(40, 40, CV_8U, cv::Scalar(1)));
  double sum = 0;
  for (int b = 4; b < 256; b += 8) {
    for (int g = 4; g < 256; g += 8) {
      cv::Mat row(1, 32, CV_32FC3);
      for (int r = 0; r < 32; ++r) {
        row.at<cv::Vec3f>(0, r) = cv::Vec3f(static_cast<float>(b), static_cast<float>(g),
                                            8.F * static_cast<float>(r) + 4);
      }
      cv::Mat density;
      cv::exp(colours.log_likelihood(row), density);
      sum += cv::sum(density)[0] * 8 * 8 * 8;
    }
  }
  EXPECT_NEAR(sum, 1, 0.01);
}

}  // namespace
}  // namespace posevote
