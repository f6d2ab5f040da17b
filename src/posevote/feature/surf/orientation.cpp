#include "posevote/feature/surf/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace posevote::surf {
namespace {

// Positions past the margin are moved to it.
simd::WaveletGrid read_grid(const Integral& integral, int x0, int y0, int step) {
  simd::WaveletGrid grid;
  int columns[simd::kWaveletNodes];
  for (int i = 0; i < simd::kWaveletNodes; ++i)
    columns[i] = std::clamp(x0 + i * step, 0, integral.width());
  const simd::SumsView view = integral.view();
  for (int j = 0; j < simd::kWaveletNodes; ++j) {
    const std::uint32_t* row =
        view.sums + std::clamp(y0 + j * step, 0, integral.height()) * view.stride;
    for (int i = 0; i < simd::kWaveletNodes; ++i)
      grid.sums[j][i] = static_cast<std::int32_t>(row[columns[i]]);
    std::fill(grid.sums[j] + simd::kWaveletNodes, std::end(grid.sums[j]), 0);
  }
  return grid;
}

}  // namespace

float orientation(const Integral& integral, const Keypoint& keypoint) {
  const int step = std::max(1, static_cast<int>(std::lround(keypoint.scale)));
  constexpr int kMiddle = simd::kWaveletNodes / 2;
  const int x0 = static_cast<int>(std::lround(keypoint.x)) + kMargin - kMiddle * step;
  const int y0 = static_cast<int>(std::lround(keypoint.y)) + kMargin - kMiddle * step;
  const auto first = [&](int origin) { return std::max(0, (step - 1 - origin) / step); };
  const auto last = [&](int origin, int size) {
    return std::min(simd::kWaveletSide - 1, (size - origin) / step - 4);
  };
  float x[simd::kAngleBins], y[simd::kAngleBins];
  simd::sector_sums(read_grid(integral, x0, y0, step),
                    {first(y0), last(y0, integral.height()), first(x0), last(x0, integral.width())},
                    x, y);
  int best = 0;
  for (int bin = 1; bin < simd::kAngleBins; ++bin)
    if (x[bin] * x[bin] + y[bin] * y[bin] > x[best] * x[best] + y[best] * y[best]) best = bin;
  const float angle = std::atan2(y[best], x[best]);
  return angle < std::numbers::pi_v<float> ? angle : -std::numbers::pi_v<float>;
}

}  // namespace posevote::surf
