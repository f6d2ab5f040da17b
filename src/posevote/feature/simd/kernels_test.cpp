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
    std::vector<std::uint32_t> made((kWidth + 1) * (kHeight + 1) + kSlack);
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
  for (const auto& [first, second] :
       {std::pair{5, 7}, {3, 0}, {5, 0}, {9, 11}, {7, 5}, {kLargestLobe, 0}})
    for (const int count : {0, 1, 7, 8, 9, 31, 50}) {
      std::vector<float> expected(count + kSlack), found(count + kSlack);
      const auto norm = [](int lobe) { return 1.0F / static_cast<float>(lobe * lobe); };
      const FilterPair filters{{first, second}, {norm(first), second ? norm(second) : 0}};
      plain::hessian_row(view, 50, 60, count, filters, expected.data());
      hessian_row(view, 50, 60, count, filters, found.data());
      found.resize(count);
      expected.resize(count);
      ASSERT_EQ(found, expected) << first << " " << second << " " << count;
    }
}

TEST_P(Kernels, HessianRowIsThePlainOneOverSeveralTiles) {
  const cv::Mat wide = made::texture(1300, 40);
  std::vector<std::uint32_t> made(1301 * 41 + kSlack);
  for (int y = 0; y < 40; ++y)
    plain::integral_row(wide.ptr(y), &made[y * 1301 + 1], 1300, &made[(y + 1) * 1301 + 1]);
  const SumsView sums_of_wide{made.data(), 1301, 1300, 40};
  for (const int count : {512, 513, 1025, 1270}) {
    const FilterPair filters{{5, 7}, {0.04F, 0.02F}};
    std::vector<float> expected(count + kSlack), found(count + kSlack);
    plain::hessian_row(sums_of_wide, 12, 20, count, filters, expected.data());
    hessian_row(sums_of_wide, 12, 20, count, filters, found.data());
    found.resize(count);
    expected.resize(count);
    ASSERT_EQ(found, expected) << count;
  }
}

TEST_P(Kernels, HessianPatchIsThePlainOneUpToTheCorners) {
  for (const int lobe : {3, 5, 9, kLargestLobe}) {
    const int reach = lobe + lobe / 2 + 1;
    for (const auto& [x, y] :
         {std::pair{reach, reach}, {70, 60}, {kWidth - 1 - reach, kHeight - 1 - reach}}) {
      std::vector<float> expected(9), found(9);
      plain::hessian_patch(view, x, y, lobe, 0.01F, expected.data());
      hessian_patch(view, x, y, lobe, 0.01F, found.data());
      ASSERT_EQ(found, expected) << lobe << " " << x;
    }
  }
}

TEST_P(Kernels, FindPeaksIsThePlainOneAlsoWithEqualValues) {
  cv::RNG random(3);
  int peaks = 0;
  for (int round = 0; round < 200; ++round) {
    const int count = random.uniform(0, 70);
    std::vector<std::vector<float>> values(3, std::vector<float>(count + 1));
    const float* rows[3];
    for (int r = 0; r < 3; ++r) {
      for (float& value : values[r]) value = static_cast<float>(random.uniform(0, 20));
      rows[r] = values[r].data();
    }
    std::vector<int> expected(count + 1), found(count + 1);
    const int many = plain::find_peaks(rows, count, 18, expected.data());
    ASSERT_EQ(find_peaks(rows, count, 18, found.data()), many);
    ASSERT_EQ(found, expected);
    peaks += many;
  }
  EXPECT_GT(peaks, 20);
}

TEST_P(Kernels, DescriptorIsThePlainOneInsideAndAcrossTheBorder) {
  for (const auto& [x, y] :
       {std::pair{75.3F, 60.8F}, {0.0F, 0.0F}, {150.2F, 131.9F}, {-900.0F, 5.0F}})
    for (const float angle : {0.0F, 0.6F, 2.5F, -1.9F})
      for (const float spacing : {0.2F, 1.7F, 4.2F, 30.0F}) {
        const PatchFrame frame{x, y, spacing * std::cos(angle), spacing * std::sin(angle),
                               std::max(1, static_cast<int>(std::lround(spacing)))};
        float expected[kDescriptorSize], found[kDescriptorSize];
        plain::descriptor(view, frame, expected);
        descriptor(view, frame, found);
        for (int i = 0; i < kDescriptorSize; ++i) ASSERT_NEAR(found[i], expected[i], 1e-5) << i;
        ASSERT_NEAR(cv::norm(cv::Mat(1, kDescriptorSize, CV_32F, found)), 1, 1e-5);
      }
}

TEST_P(Kernels, DescriptorOfAFlatPictureHasEqualNumbers) {
  const std::vector<std::uint32_t> nothing(sums.size());
  float found[kDescriptorSize];
  descriptor({nothing.data(), view.stride, kWidth, kHeight}, {70, 60, 2, 1, 2}, found);
  for (const float value : found) EXPECT_EQ(value, 0.125F);
}

TEST_P(Kernels, SectorSumsAreThePlainOnes) {
  cv::RNG random(5);
  for (int round = 0; round < 50; ++round) {
    WaveletGrid grid{};
    for (auto& row : grid.sums)
      for (std::int32_t& sum : row) sum = random.uniform(-100000, 100000);
    const WaveletRange range = round % 2 ? WaveletRange{0, 7, 0, 7}
                                         : WaveletRange{random.uniform(0, 5), random.uniform(4, 8),
                                                        random.uniform(0, 9), 7};
    float expected[2 * kAngleBins], found[2 * kAngleBins];
    plain::sector_sums(grid, range, expected);
    const int longest = sector_sums(grid, range, found);
    for (int i = 0; i < 2 * kAngleBins; ++i) ASSERT_NEAR(found[i], expected[i], 2) << i;  // of 1e5
    const auto length = [&](std::ptrdiff_t b) {
      return std::hypot(found[2 * b], found[2 * b + 1]);
    };
    for (int b = 0; b < kAngleBins; ++b) EXPECT_LE(length(b), length(longest) * 1.000001);
  }
}

TEST_P(Kernels, SectorSumsOfNothingAreZero) {
  float pairs[2 * kAngleBins];
  EXPECT_EQ(sector_sums(WaveletGrid{}, {0, 7, 0, 7}, pairs), 0);
  for (const float value : pairs) EXPECT_EQ(value, 0);
}

TEST_P(Kernels, SectorSumsOfARampPointUpTheRamp) {
  for (const float degrees : {2.0F, 47.0F, 93.0F, 178.0F, 182.0F, 268.0F, 272.0F, 358.0F}) {
    const double c = std::cos(degrees * CV_PI / 180), s = std::sin(degrees * CV_PI / 180);
    WaveletGrid grid{};  // sums of the ramp c x + s y
    for (int y = 0; y < kWaveletNodes; ++y)
      for (int x = 0; x < kWaveletNodes; ++x)
        grid.sums[y][x] =
            static_cast<std::int32_t>(std::lround(1e4 * (c * x * x * y + s * y * y * x)));
    float pairs[2 * kAngleBins];
    sector_sums(grid, {0, 7, 0, 7}, pairs);
    const auto bin = static_cast<std::ptrdiff_t>(degrees / 5);
    const float x = pairs[2 * bin], y = pairs[2 * bin + 1];
    EXPECT_GT(x * c + y * s, 0);
    EXPECT_NEAR(std::atan2(x * s - y * c, x * c + y * s), 0, 1e-3);
    for (int k = 0; k < 2; ++k) EXPECT_EQ(pairs[2 * ((bin + 1) % kAngleBins) + k], 0);
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
