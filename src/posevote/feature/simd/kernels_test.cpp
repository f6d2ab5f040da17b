#include "posevote/feature/simd/kernels.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <opencv2/core.hpp>
#include <vector>

#include "posevote/feature/made_pictures.hpp"

namespace posevote::simd {
namespace {

// Every test runs once for each instruction set that this CPU has.
class Kernels : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { use(GetParam()); }
  void TearDown() override { use(0); }
  static void use(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }

  static constexpr int kWidth = 151, kHeight = 133;
  cv::Mat grey = made::texture(kWidth, kHeight);
  std::vector<std::uint32_t> sums = [this] {
    std::vector<std::uint32_t> made((kWidth + 1) * (kHeight + 1));
    for (int y = 0; y < kHeight; ++y)
      plain::integral_row(grey.ptr(y), &made[y * (kWidth + 1) + 1], kWidth,
                          &made[(y + 1) * (kWidth + 1) + 1]);
    return made;
  }();
  SumsView view{sums.data(), kWidth + 1, kWidth, kHeight};
};

TEST_P(Kernels, SmoothRowIsThePlainOneForAnyLength) {
  for (int count = 0; count < 80; ++count) {
    const std::uint8_t* rows[5];
    for (int i = 0; i < 5; ++i) rows[i] = grey.ptr(i) + 2;
    std::vector<std::uint16_t> scratch(count + 36);
    std::vector<std::uint8_t> expected(count + 1, 9), found(count + 1, 9);
    plain::smooth_row(rows, count, scratch.data(), expected.data());
    smooth_row(rows, count, scratch.data(), found.data());
    ASSERT_EQ(found, expected) << count;
  }
}

TEST_P(Kernels, SmoothRowKeepsWhiteWhite) {
  const std::vector<std::uint8_t> white(100, 255);
  const std::uint8_t* const row = white.data() + 2;
  const std::uint8_t* rows[5] = {row, row, row, row, row};
  std::vector<std::uint16_t> scratch(96 + 36);
  std::vector<std::uint8_t> found(96);
  smooth_row(rows, 96, scratch.data(), found.data());
  EXPECT_EQ(found, std::vector<std::uint8_t>(96, 255));
}

TEST_P(Kernels, IntegralRowIsThePlainOneAndWrapsAround) {
  for (int count = 0; count < 70; ++count) {
    std::vector<std::uint32_t> above(count + 1, 0xFFFFFF00U), expected(count + 1), found(count + 1);
    plain::integral_row(grey.ptr(3), above.data(), count, expected.data());
    integral_row(grey.ptr(3), above.data(), count, found.data());
    ASSERT_EQ(found, expected) << count;
  }
}

TEST_P(Kernels, HessianRowIsThePlainOneBitForBit) {
  for (const int lobe : {3, 5, 7, 9, 13, 33})
    for (const int count : {0, 1, 7, 8, 9, 31, 50}) {
      std::vector<float> expected(count + 1, 9), found(count + 1, 9);
      const float norm = 1.0F / static_cast<float>(lobe * lobe);
      plain::hessian_row(view, 50, 60, count, lobe, norm, expected.data());
      hessian_row(view, 50, 60, count, lobe, norm, found.data());
      ASSERT_EQ(found, expected) << lobe << " " << count;
    }
}

TEST_P(Kernels, FindMaximaIsThePlainOneAlsoWithEqualValues) {
  cv::RNG random(3);
  for (int round = 0; round < 200; ++round) {
    const int count = random.uniform(0, 70);
    std::vector<std::vector<float>> values(kMaximaRows, std::vector<float>(count + 1));
    const float* rows[kMaximaRows];
    for (int r = 0; r < kMaximaRows; ++r) {
      for (float& value : values[r]) value = static_cast<float>(random.uniform(0, 20));
      rows[r] = values[r].data();
    }
    for (int i = 2; i < count - 2; i += 5) values[4][i] = 25;
    std::vector<int> expected(count + 1), found(count + 1);
    const int many = plain::find_maxima(rows, count, 18, expected.data());
    ASSERT_EQ(find_maxima(rows, count, 18, found.data()), many);
    ASSERT_EQ(found, expected);
  }
}

TEST_P(Kernels, DescriptorIsThePlainOneInsideAndAcrossTheBorder) {
  for (const auto& [x, y] : {std::pair{75.3F, 60.8F}, {0.0F, 0.0F}, {150.2F, 131.9F}})
    for (const float angle : {0.0F, 0.6F, 2.5F, -1.9F})
      for (const float scale : {1.0F, 1.7F, 4.2F, 30.0F}) {
        const PatchFrame frame{x, y, scale * std::cos(angle), scale * std::sin(angle),
                               static_cast<int>(scale + 0.5F)};
        float expected[kDescriptorSize], found[kDescriptorSize];
        plain::descriptor(view, frame, expected);
        descriptor(view, {}, frame, found);
        float largest = 1;
        for (const float value : expected) largest = std::max(largest, std::abs(value));
        for (int i = 0; i < kDescriptorSize; ++i)
          ASSERT_NEAR(found[i] / largest, expected[i] / largest, 2e-5) << i;
      }
}

TEST_P(Kernels, BoxRowIsThePlainOneUpToTheLargestSum) {
  std::vector<std::uint32_t> white(sums.size());
  for (int y = 0; y <= kHeight; ++y)
    for (int x = 0; x <= kWidth; ++x)
      white[y * (kWidth + 1) + x] = static_cast<std::uint32_t>(255 * x * y);
  for (const SumsView& picture : {view, SumsView{white.data(), view.stride, kWidth, kHeight}})
    for (const int side : {1, 2, 5, 16})
      for (const int count : {0, 1, 9, 64, kWidth - side + 1}) {
        std::vector<std::uint16_t> expected(count + 1), found(count + 1);
        plain::box_row(picture, 20, side, count, expected.data());
        box_row(picture, 20, side, count, found.data());
        ASSERT_EQ(found, expected) << side << " " << count;
      }
}

TEST_P(Kernels, DescriptorFromBoxesIsTheSameBitForBit) {
  for (const int side : {1, 2, 7, 16}) {
    std::vector<std::uint16_t> boxes(view.stride * kHeight);
    for (int y = 0; y + side <= kHeight; ++y)
      box_row(view, y, side, kWidth - side + 1, &boxes[y * view.stride]);
    for (const auto& [x, y] : {std::pair{75.3F, 60.8F}, {150.9F, 132.9F}}) {
      const auto scale = static_cast<float>(side);
      const PatchFrame frame{x, y, scale * 0.8F, scale * 0.6F, side};
      float expected[kDescriptorSize], found[kDescriptorSize];
      descriptor(view, {}, frame, expected);
      descriptor(view, {boxes.data(), view.stride}, frame, found);
      for (int i = 0; i < kDescriptorSize; ++i) ASSERT_EQ(found[i], expected[i]);
    }
  }
}

TEST_P(Kernels, SectorSumsAreThePlainOnes) {
  cv::RNG random(5);
  for (int round = 0; round < 50; ++round) {
    WaveletGrid grid{};
    for (auto& row : grid.sums)
      for (int i = 0; i < kWaveletNodes; ++i) row[i] = random.uniform(-100000, 100000);
    const WaveletRange range = round % 2 ? WaveletRange{0, 10, 0, 10}
                                         : WaveletRange{random.uniform(0, 6), random.uniform(5, 11),
                                                        random.uniform(0, 12), 10};
    float expected[2][kAngleBins], found[2][kAngleBins];
    plain::sector_sums(grid, range, expected[0], expected[1]);
    sector_sums(grid, range, found[0], found[1]);
    for (int i = 0; i < kAngleBins; ++i)
      for (int k = 0; k < 2; ++k) ASSERT_NEAR(found[k][i], expected[k][i], 2) << i;  // of 1e5
  }
}

TEST_P(Kernels, SectorSumsOfARampPointUpTheRamp) {
  for (const float degrees : {2.0F, 47.0F, 93.0F, 178.0F, 182.0F, 268.0F, 272.0F, 358.0F}) {
    const double c = std::cos(degrees * CV_PI / 180), s = std::sin(degrees * CV_PI / 180);
    WaveletGrid grid{};  // sums of the ramp c x + s y
    for (int y = 0; y < kWaveletNodes; ++y)
      for (int x = 0; x < kWaveletNodes; ++x)
        grid.sums[y][x] =
            static_cast<std::int32_t>(std::lround(1e4 * (c * x * x * y + s * y * y * x)));
    float x[kAngleBins], y[kAngleBins];
    sector_sums(grid, {0, 10, 0, 10}, x, y);
    const int bin = static_cast<int>(degrees / 5);
    EXPECT_GT(x[bin] * c + y[bin] * s, 0);
    EXPECT_NEAR(std::atan2(x[bin] * s - y[bin] * c, x[bin] * c + y[bin] * s), 0, 1e-3);
    EXPECT_EQ(x[(bin + 1) % kAngleBins], 0);
    EXPECT_EQ(y[(bin + 1) % kAngleBins], 0);
  }
}

std::string name_of(const testing::TestParamInfo<std::int64_t>& test) {
  std::string name = hwy::TargetName(test.param);
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return name;
}

INSTANTIATE_TEST_SUITE_P(Targets, Kernels, testing::ValuesIn([] {
                           const auto targets = hwy::SupportedAndGeneratedTargets();
                           return std::vector<std::int64_t>(targets.begin(), targets.end());
                         }()),
                         name_of);

}  // namespace
}  // namespace posevote::simd
