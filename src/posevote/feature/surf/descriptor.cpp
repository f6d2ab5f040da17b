#include "posevote/feature/surf/descriptor.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace posevote::surf {
namespace {

constexpr int kSamples = 20;
constexpr int kNodes = kSamples + 1;
using Patch = std::array<std::array<float, kNodes>, kNodes>;

// Means of squares of side s around the nodes of the turned grid.
Patch sample_patch(const Integral& integral, const Keypoint& keypoint) {
  const int limit = std::min(integral.width(), integral.height());
  const int side = std::clamp(static_cast<int>(std::lround(keypoint.scale)), 1, limit);
  const float cosine = std::cos(keypoint.angle) * keypoint.scale;
  const float sine = std::sin(keypoint.angle) * keypoint.scale;
  const float half = static_cast<float>(side - 1) / 2;
  Patch patch;
  for (int j = 0; j < kNodes; ++j)
    for (int i = 0; i < kNodes; ++i) {
      const auto u = static_cast<float>(i - kSamples / 2), v = static_cast<float>(j - kSamples / 2);
      const float x = keypoint.x + u * cosine - v * sine - half;
      const float y = keypoint.y + u * sine + v * cosine - half;
      const int x0 = std::clamp(static_cast<int>(std::floor(x + 0.5F)), 0, integral.width() - side);
      const int y0 =
          std::clamp(static_cast<int>(std::floor(y + 0.5F)), 0, integral.height() - side);
      patch[j][i] = static_cast<float>(integral.box(x0, y0, x0 + side, y0 + side)) /
                    static_cast<float>(side * side);
    }
  return patch;
}

void normalize(float* descriptor) {
  double sum = 0;
  for (int i = 0; i < kDescriptorSize; ++i) sum += descriptor[i] * descriptor[i];
  if (sum < 1e-12) {
    std::fill_n(descriptor, kDescriptorSize, 0.125F);
    return;
  }
  const auto scale = static_cast<float>(1 / std::sqrt(sum));
  for (int i = 0; i < kDescriptorSize; ++i) descriptor[i] *= scale;
}

}  // namespace

void describe(const Integral& integral, const Keypoint& keypoint, float* descriptor) {
  const Patch patch = sample_patch(integral, keypoint);
  std::fill_n(descriptor, kDescriptorSize, 0.0F);
  for (int j = 0; j < kSamples; ++j)
    for (int i = 0; i < kSamples; ++i) {
      const float u = static_cast<float>(i) - 9.5F, v = static_cast<float>(j) - 9.5F;
      const float weight = std::exp(-(u * u + v * v) / (2 * 3.3F * 3.3F));
      const float right = patch[j][i + 1] + patch[j + 1][i + 1];
      const float left = patch[j][i] + patch[j + 1][i];
      const float below = patch[j + 1][i] + patch[j + 1][i + 1];
      const float above = patch[j][i] + patch[j][i + 1];
      const float dx = weight * (right - left), dy = weight * (below - above);
      for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) {
          const float share_x = 1 - std::abs(u - (static_cast<float>(column) * 5 - 7.5F)) / 5;
          const float share_y = 1 - std::abs(v - (static_cast<float>(row) * 5 - 7.5F)) / 5;
          if (share_x <= 0 || share_y <= 0) continue;
          const float share = share_x * share_y;
          float* sums = descriptor + (row * 4 + column) * 4;
          sums[0] += share * dx;
          sums[1] += share * dy;
          sums[2] += share * std::abs(dx);
          sums[3] += share * std::abs(dy);
        }
    }
  normalize(descriptor);
}

}  // namespace posevote::surf
