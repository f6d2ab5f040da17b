#include "posevote/feature/surf/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace posevote::surf {
namespace {

constexpr float kSpacing = 1.5F;  // of the points, scales

// Positions past the margin are moved to it.
simd::WaveletGrid read_grid(const simd::SumsView& view, int x0, int y0, int step) {
  simd::WaveletGrid grid;
  constexpr int kLast = simd::kWaveletNodes - 1;
  if (x0 >= 0 && y0 >= 0 && x0 + kLast * step <= view.width && y0 + kLast * step <= view.height) {
    const std::uint32_t* at = view.sums + y0 * view.stride + x0;
    for (auto& row : grid.sums) {
      for (std::ptrdiff_t i = 0; i <= kLast; ++i) row[i] = static_cast<std::int32_t>(at[i * step]);
      at += step * view.stride;
    }
    return grid;
  }
  for (int j = 0; j <= kLast; ++j) {
    const std::uint32_t* row = view.sums + std::clamp(y0 + j * step, 0, view.height) * view.stride;
    for (int i = 0; i <= kLast; ++i)
      grid.sums[j][i] = static_cast<std::int32_t>(row[std::clamp(x0 + i * step, 0, view.width)]);
  }
  return grid;
}

}  // namespace

float orientation(const Integral& integral, const Keypoint& keypoint) {
  const int step = std::max(1, static_cast<int>(std::lround(kSpacing * keypoint.scale)));
  const auto origin = [&](float centre) {  // of the grid, whose middle is between two nodes
    const float nodes = static_cast<float>(simd::kWaveletNodes - 1) / 2;
    return static_cast<int>(std::lround(centre + 0.5F - nodes * static_cast<float>(step))) +
           kMargin;
  };
  const int x0 = origin(keypoint.x), y0 = origin(keypoint.y);
  const auto first = [&](int at) { return std::max(0, (step - 1 - at) / step); };
  const auto last = [&](int at, int size) {
    return std::min(simd::kWaveletSide - 1, (size - at) / step - 4);
  };
  float pairs[2 * simd::kAngleBins];
  const std::ptrdiff_t best = simd::sector_sums(
      read_grid(integral.view(), x0, y0, step),
      {first(y0), last(y0, integral.height()), first(x0), last(x0, integral.width())}, pairs);
  const float angle = std::atan2(pairs[2 * best + 1], pairs[2 * best]);
  return angle < std::numbers::pi_v<float> ? angle : -std::numbers::pi_v<float>;
}

}  // namespace posevote::surf
