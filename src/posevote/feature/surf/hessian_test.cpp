#include "posevote/feature/surf/hessian.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "posevote/feature/made_pictures.hpp"

namespace posevote::surf {
namespace {

// Bay et al. 2008, fig. 1 and 4, by definition: the weight of the pixel (u, v) off the centre.
struct Weights {
  int xx, yy, xy;
};
Weights weights_at(int size, int u, int v) {
  const int lobe = size / 3;
  const auto second = [&](int along, int across) {
    if (std::abs(along) > size / 2 || std::abs(across) >= lobe) return 0;
    return std::abs(along) <= lobe / 2 ? -2 : 1;
  };
  const bool corner = u != 0 && v != 0 && std::abs(u) <= lobe && std::abs(v) <= lobe;
  return {second(u, v), second(v, u), corner ? ((u > 0) == (v > 0) ? 1 : -1) : 0};
}

TEST(Integral, IsThePlainSumOfEveryRectangle) {
  const cv::Mat grey = made::texture(13, 9);
  Integral integral;
  integral.compute(grey);
  for (int y0 = 0; y0 <= 9; ++y0)
    for (int y1 = y0; y1 <= 9; ++y1)
      for (int x0 = 0; x0 <= 13; ++x0)
        for (int x1 = x0; x1 <= 13; ++x1)
          ASSERT_EQ(integral.box(x0, y0, x1, y1),
                    static_cast<unsigned>(cv::sum(grey(cv::Range(y0, y1), cv::Range(x0, x1)))[0]));
}

TEST(Integral, SmallSumsStayExactWhenTheTotalOverflows) {
  const cv::Mat white(4200, 4200, CV_8U, cv::Scalar(255));  // 4.5e9 > 2^32
  Integral integral;
  integral.compute(white);
  EXPECT_EQ(integral.box(4190, 4190, 4200, 4200), 25500U);
}

TEST(SecondDerivatives, AreTheWeightedSumsOfTheirDefinition) {
  const cv::Mat grey = made::texture(80, 70);
  Integral integral;
  integral.compute(grey);
  for (const int size : {9, 15, 21, 27, 39, 51})
    for (const cv::Point at : {cv::Point(40, 35), cv::Point(size / 2, size / 2),
                               cv::Point(79 - size / 2, 69 - size / 2)}) {
      SecondDerivatives expected{};
      for (int v = -(size / 2); v <= size / 2; ++v)
        for (int u = -(size / 2); u <= size / 2; ++u) {
          const Weights weights = weights_at(size, u, v);
          const int pixel = grey.at<std::uint8_t>(at.y + v, at.x + u);
          expected.xx += weights.xx * pixel;
          expected.yy += weights.yy * pixel;
          expected.xy += weights.xy * pixel;
        }
      const SecondDerivatives found = second_derivatives(integral, size, at.x, at.y);
      EXPECT_EQ(found.xx, expected.xx) << size;
      EXPECT_EQ(found.yy, expected.yy) << size;
      EXPECT_EQ(found.xy, expected.xy) << size;
    }
}

TEST(FilterSize, FollowsThePaper) {
  EXPECT_EQ(filter_size(0, 0), 9);
  EXPECT_EQ(filter_size(0, 3), 27);
  EXPECT_EQ(filter_size(1, 0), 15);
  EXPECT_EQ(filter_size(1, 3), 51);
  EXPECT_EQ(filter_size(3, 3), 195);
  EXPECT_FLOAT_EQ(scale_of_filter(9), 1.2F);
}

class Spot : public testing::TestWithParam<std::tuple<double, bool>> {};

TEST_P(Spot, IsFoundAtItsPlaceScaleAndSign) {
  const auto [sigma, dark] = GetParam();
  const double x = 150.3, y = 140.8;
  Integral integral;
  integral.compute(made::spot(300, 290, x, y, sigma, dark));
  const auto blobs = find_blobs(integral, SurfOptions{});
  ASSERT_FALSE(blobs.empty());
  const Keypoint& best = *std::ranges::max_element(blobs, {}, &Keypoint::response);
  EXPECT_NEAR(best.x, x, 0.1 * sigma);
  EXPECT_NEAR(best.y, y, 0.1 * sigma);
  // A box filter of nominal scale s answers most to a spot of sigma s / 0.7 (Gaussian: s).
  EXPECT_NEAR(best.scale / sigma, 0.72, 0.05);
  EXPECT_EQ(best.laplacian, dark ? 1 : -1);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Spot,
                         testing::Combine(testing::Values(2.8, 4.0, 6.5, 10.0, 16.0),
                                          testing::Bool()));

TEST(FindBlobs, ThresholdLeavesOutExactlyTheWeaker) {
  Integral integral;
  integral.compute(made::texture(200, 150));
  SurfOptions options;
  const auto all = find_blobs(integral, options);
  options.hessian_threshold = 2000;
  const auto strong = find_blobs(integral, options);
  const auto expected =
      std::ranges::count_if(all, [](const Keypoint& k) { return k.response >= 2000; });
  EXPECT_GT(strong.size(), 0U);
  EXPECT_LT(strong.size(), all.size());
  EXPECT_EQ(strong.size(), static_cast<std::size_t>(expected));
}

}  // namespace
}  // namespace posevote::surf
