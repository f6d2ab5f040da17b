#include "posevote/feature/surf/hessian.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <tuple>

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

struct IntegralOf : Integral {
  explicit IntegralOf(const cv::Mat& grey, bool smooth = false, int threads = 1) {
    Team team;
    compute(grey, smooth, 4, team, threads);
  }
};

cv::Mat with_margin(const cv::Mat& grey) {
  cv::Mat extended;
  cv::copyMakeBorder(grey, extended, kMargin, kMargin, kMargin, kMargin, cv::BORDER_REPLICATE);
  return extended;
}

TEST(Integral, IsThePlainSumOfEveryRectangle) {
  const cv::Mat grey = made::texture(5, 3), extended = with_margin(grey);
  const IntegralOf integral(grey);
  ASSERT_EQ(cv::Size(integral.width(), integral.height()), extended.size());
  for (int y0 = 0; y0 <= extended.rows; y0 += 3)
    for (int y1 = y0; y1 <= extended.rows; y1 += 5)
      for (int x0 = 0; x0 <= extended.cols; x0 += 3)
        for (int x1 = x0; x1 <= extended.cols; x1 += 4)
          ASSERT_EQ(
              integral.box(x0, y0, x1, y1),
              static_cast<unsigned>(cv::sum(extended(cv::Range(y0, y1), cv::Range(x0, x1)))[0]));
}

TEST(Integral, SmallSumsStayExactWhenTheTotalOverflows) {
  const cv::Mat white(4200, 4200, CV_8U, cv::Scalar(255));  // 4.5e9 > 2^32
  const IntegralOf integral(white);
  EXPECT_EQ(integral.box(4190, 4190, 4200, 4200), 25500U);
}

TEST(Integral, SmoothsByTheBinomialFilter) {
  for (const cv::Size size :
       {cv::Size(1, 1), cv::Size(3, 2), cv::Size(4, 9), cv::Size(5, 5), cv::Size(61, 40)}) {
    const cv::Mat grey = made::texture(size.width, size.height);
    const cv::Mat kernel = (cv::Mat_<float>(1, 5) << 1, 4, 6, 4, 1) / 16;
    cv::Mat smoothed, exact;
    grey.convertTo(exact, CV_32F);
    cv::sepFilter2D(exact, exact, -1, kernel, kernel, {-1, -1}, 0, cv::BORDER_REPLICATE);
    const IntegralOf integral(grey, true);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        ASSERT_NEAR(integral.box(x + kMargin, y + kMargin, x + kMargin + 1, y + kMargin + 1),
                    exact.at<float>(y, x), 0.501);
  }
}

TEST(Integral, IsTheSameForAnyTeamAndAtEveryLevel) {
  const cv::Mat grey = made::texture(71, 153);
  const IntegralOf alone(grey, true, 1);
  for (const int team : {1, 2, 3, 7, 64}) {
    const IntegralOf shared(grey, true, team);
    for (int level = 0; level < 4; ++level) {
      const simd::SumsView view = shared.view(level);
      ASSERT_EQ(view.width, alone.width() >> level);
      ASSERT_EQ(view.height, alone.height() >> level);
      for (int y = 0; y <= view.height; ++y)
        for (int x = 0; x <= view.width; ++x)
          ASSERT_EQ(view.sums[y * view.stride + x], alone.at(y << level, x << level)) << level;
    }
  }
}

TEST(Integral, KeepsNothingOfALargerPictureBefore) {
  Integral integral;
  Team team;
  for (const cv::Size size : {cv::Size(90, 80), cv::Size(20, 30), cv::Size(1, 1)}) {
    const cv::Mat grey = made::texture(size.width, size.height);
    integral.compute(grey, true, 3, team, 1);
    const IntegralOf fresh(grey, true);
    for (int level = 0; level < 3; ++level)
      for (int y = 0; y <= fresh.view(level).height; ++y)
        for (int x = 0; x <= fresh.view(level).width; ++x)
          ASSERT_EQ(integral.view(level).sums[y * integral.view(level).stride + x],
                    fresh.view(level).sums[y * fresh.view(level).stride + x]);
  }
}

// The determinant by its definition.
float determinant_at(const cv::Mat& extended, int size, int x, int y) {
  double xx = 0, yy = 0, xy = 0;
  for (int v = -(size / 2); v <= size / 2; ++v)
    for (int u = -(size / 2); u <= size / 2; ++u) {
      const Weights weights = weights_at(size, u, v);
      const int pixel = extended.at<std::uint8_t>(y + kMargin + v, x + kMargin + u);
      xx += weights.xx * pixel;
      yy += weights.yy * pixel;
      xy += weights.xy * pixel;
    }
  const double norm = hessian_norm(size);
  return static_cast<float>((xx * yy - 0.81 * xy * xy) * norm * norm);
}

TEST(HessianPatch, IsTheWeightedSumOfItsDefinition) {
  const cv::Mat grey = made::texture(80, 70), extended = with_margin(grey);
  const IntegralOf integral(grey);
  for (const int size : {9, 15, 21, 27, 39, 51})
    for (const cv::Point at : {cv::Point(40, 35), cv::Point(0, 0), cv::Point(79, 69)}) {
      float found[9];
      simd::hessian_patch(integral.view(), at.x + kMargin, at.y + kMargin, size / 3,
                          hessian_norm(size), found);
      const float expected = determinant_at(extended, size, at.x, at.y);
      EXPECT_NEAR(found[4], expected, 1e-3 + 1e-4 * std::abs(expected)) << size;
    }
}

std::vector<Candidate> search(const cv::Mat& grey, const SurfOptions& options, int team_size = 1) {
  const IntegralOf integral(grey, options.smooth);
  BlobSearch blobs;
  Team team;
  blobs.search(integral, options, team, team_size);
  std::vector<Candidate> all;
  blobs.for_each_peak([&](const Peak& peak) {
    if (const auto candidate = examine(peak, integral, options)) all.push_back(*candidate);
  });
  std::ranges::sort(all, {},
                    [](const Candidate& c) { return std::tuple(c.octave, c.layer, c.y, c.x); });
  return all;
}

// Every sample of every octave against its 26 neighbours, without pairs, rings or peaks.
std::vector<Candidate> search_plainly(const cv::Mat& grey, const SurfOptions& options) {
  const IntegralOf integral(grey, options.smooth);
  std::vector<Candidate> all;
  for (int octave = 0; octave < options.octaves; ++octave)
    for (int layer = 1; layer <= options.layers; ++layer) {
      const simd::SumsView view = integral.view(octave);
      const int reach = filter_size(0, options.layers + 1) / 2 + 1, step = 1 << octave;
      const auto lies_inside = [&](int at, int length, int level_length) {
        const double place = (at + 0.5) * step - 0.5 - kMargin;  // in the picture
        return place - step >= 0 && place + step <= length - 1 && at >= reach &&
               at + reach < level_length;
      };
      for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
          if (!lies_inside(x, grey.cols, view.width) || !lies_inside(y, grey.rows, view.height))
            continue;
          Candidate candidate{octave, layer, x, y, {}};
          for (int k = 0; k < 3; ++k)
            simd::plain::hessian_patch(view, x, y, lobe_of(layer - 1 + k),
                                       hessian_norm(filter_size(octave, layer - 1 + k)),
                                       candidate.around[k][0].data());
          bool is_maximum = true;
          for (int k = 0; k < 27; ++k)
            is_maximum &=
                k == 13 || candidate.around[k / 9][k / 3 % 3][k % 3] < candidate.response();
          if (is_maximum && candidate.response() >= options.hessian_threshold)
            all.push_back(candidate);
        }
    }
  return all;
}

void expect_same(const std::vector<Candidate>& found, const std::vector<Candidate>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(std::tie(found[i].octave, found[i].layer, found[i].x, found[i].y),
              std::tie(expected[i].octave, expected[i].layer, expected[i].x, expected[i].y));
    EXPECT_EQ(found[i].around, expected[i].around);
  }
}

TEST(BlobSearch, FindsWhatThePlainSearchFinds) {
  for (const cv::Size size :
       {cv::Size(130, 101), cv::Size(97, 160), cv::Size(20, 30), cv::Size(1, 1)})
    for (const int layers : {1, 2, 3, 4, 8}) {
      SurfOptions options;
      options.hessian_threshold = 10;
      options.layers = layers;
      const cv::Mat grey = made::texture(size.width, size.height);
      expect_same(search(grey, options), search_plainly(grey, options));
    }
}

TEST(BlobSearch, IsTheSameForAnyTeam) {
  const cv::Mat grey = made::texture(150, 133);
  const auto alone = search(grey, {}, 1);
  ASSERT_GT(alone.size(), 20U);
  for (const int team : {2, 3, 5, 16}) expect_same(search(grey, {}, team), alone);
}

std::vector<Keypoint> find_blobs(const cv::Mat& grey, const SurfOptions& options) {
  const IntegralOf integral(grey);
  std::vector<Keypoint> blobs;
  for (const Candidate& candidate : search(grey, options))
    if (const auto blob = refine(candidate, integral)) blobs.push_back(*blob);
  return blobs;
}

TEST(FilterSize, IsThePapersInOctave0AndDoublesWithEachOctave) {
  EXPECT_EQ(filter_size(0, 0), 9);
  EXPECT_EQ(filter_size(0, 3), 27);
  EXPECT_EQ(filter_size(1, 0), 18);
  EXPECT_EQ(filter_size(3, 3), 216);
  EXPECT_FLOAT_EQ(scale_of_filter(9), 1.2F);
}

class Spot : public testing::TestWithParam<std::tuple<double, bool>> {};

TEST_P(Spot, IsFoundAtItsPlaceScaleAndSign) {
  const auto [sigma, dark] = GetParam();
  const double x = 150.3, y = 140.8;
  SurfOptions options;
  options.smooth = false;
  const auto blobs = find_blobs(made::spot(300, 290, x, y, sigma, dark), options);
  ASSERT_FALSE(blobs.empty());
  const Keypoint& best = *std::ranges::max_element(blobs, {}, &Keypoint::response);
  EXPECT_NEAR(best.x, x, 0.1 * sigma);
  EXPECT_NEAR(best.y, y, 0.1 * sigma);
  // A box filter of nominal scale s answers most to a spot of sigma s / 0.7 (Gaussian: s), more or
  // less as the steps between the filters go.
  EXPECT_NEAR(best.scale / sigma, 0.73, 0.06);
  EXPECT_EQ(best.laplacian, dark ? 1 : -1);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Spot,
                         testing::Combine(testing::Values(2.8, 4.0, 6.5, 10.0, 16.0),
                                          testing::Bool()));

TEST(BlobSearch, ThresholdLeavesOutExactlyTheWeaker) {
  const cv::Mat grey = made::texture(200, 150);
  SurfOptions options;
  auto expected = search(grey, options);
  const std::size_t all = expected.size();
  options.hessian_threshold = 500;
  std::erase_if(expected, [](const Candidate& c) { return c.response() < 500; });
  EXPECT_GT(expected.size(), 0U);
  EXPECT_LT(expected.size(), all);
  expect_same(search(grey, options), expected);
}

TEST(Refine, RefusesAMaximumThatLiesElsewhere) {
  const IntegralOf integral(made::texture(60, 50));
  Candidate candidate{0, 1, 30 + kMargin, 25 + kMargin, {}};
  // A ridge along the diagonal that hardly falls: the quadric's top is 4.5 steps away in x and y.
  for (auto& plane : candidate.around)
    for (auto& row : plane) row = {2.9F, 2.9F, 2.9F};
  candidate.around[1] = {{{2.99F, 2.9F, 2.79F}, {2.9F, 3.0F, 2.99F}, {2.79F, 2.99F, 2.99F}}};
  EXPECT_FALSE(refine(candidate, integral));
  candidate.around = {};
  EXPECT_FALSE(refine(candidate, integral));  // flat: no maximum at all
}

}  // namespace
}  // namespace posevote::surf
