#include "posevote/feature/surf/orientation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace posevote::surf {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kReach = 5;  // samples at -5 ... 5, those within a circle of radius 6
constexpr int kSide = 2 * kReach + 1;
constexpr int kNodes = kSide + 4;        // the wavelets' corners all lie on one grid
constexpr int kBins = 72, kSector = 12;  // 5 and 60 degrees

struct Weights {
  std::array<std::array<float, 16>, kSide> at{};  // 0 outside the circle
};
const Weights& weights() {
  static const Weights made = [] {
    Weights w;
    for (int j = -kReach; j <= kReach; ++j)
      for (int i = -kReach; i <= kReach; ++i)
        if (i * i + j * j < 36)
          w.at[j + kReach][i + kReach] =
              static_cast<float>(std::exp(-(i * i + j * j) / (2 * 2.5 * 2.5)));
    return w;
  }();
  return made;
}

// The bin of an angle, from the diamond-shaped "circle" |x| + |y| = 1 straightened by a polynomial;
// wrong by less than a tenth of a bin, and free of branches.
int angle_bin(float x, float y) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float q = std::min(ax, ay) / (std::max(ax, ay) + 1e-30F), q2 = q * q;
  float angle = q * (0.99978784F + q2 * (-0.32580840F + q2 * (0.15557865F - q2 * 0.04432655F)));
  angle = ay > ax ? kPi / 2 - angle : angle;
  angle = x < 0 ? kPi - angle : angle;
  angle = y < 0 ? 2 * kPi - angle : angle;
  return static_cast<int>(angle * (kBins / (2 * kPi)));
}

struct Responses {
  std::array<std::array<float, 16>, kSide> dx, dy;
  std::array<std::array<int, 16>, kSide> bin;
};

// The grid of sums that all wavelets share; positions past the margin are moved to it.
using Grid = std::array<std::array<std::int32_t, 20>, kNodes>;

void fill_responses(const Grid& grid, const Weights& weight, Responses& out) {
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < 16; ++i) {
      const auto &top = grid[j], &middle = grid[j + 2], &bottom = grid[j + 4];
      const std::int32_t outer = bottom[i + 4] - bottom[i] - top[i + 4] + top[i];
      const std::int32_t left = bottom[i + 2] - bottom[i] - top[i + 2] + top[i];
      const std::int32_t upper = middle[i + 4] - middle[i] - top[i + 4] + top[i];
      out.dx[j][i] = static_cast<float>(outer - 2 * left) * weight.at[j][i];
      out.dy[j][i] = static_cast<float>(outer - 2 * upper) * weight.at[j][i];
      out.bin[j][i] = angle_bin(out.dx[j][i], out.dy[j][i]);
    }
}

float strongest_sector(const Responses& responses, int first_row, int last_row, int first_column,
                       int last_column) {
  std::array<float, kBins + kSector> x{}, y{};
  for (int j = first_row; j <= last_row; ++j)
    for (int i = first_column; i <= last_column; ++i) {
      const int bin = std::min(responses.bin[j][i], kBins - 1);
      x[bin] += responses.dx[j][i];
      y[bin] += responses.dy[j][i];
    }
  std::copy_n(x.begin(), kSector, x.begin() + kBins);
  std::copy_n(y.begin(), kSector, y.begin() + kBins);
  float best = -1, best_x = 1, best_y = 0;
  for (int bin = 0; bin < kBins; ++bin) {
    float sum_x = 0, sum_y = 0;
    for (int k = 0; k < kSector; ++k) {
      sum_x += x[bin + k];
      sum_y += y[bin + k];
    }
    const float length = sum_x * sum_x + sum_y * sum_y;
    if (length > best) {
      best = length;
      best_x = sum_x;
      best_y = sum_y;
    }
  }
  const float angle = std::atan2(best_y, best_x);
  return angle < kPi ? angle : -kPi;
}

}  // namespace

float orientation(const Integral& integral, const Keypoint& keypoint) {
  const int step = std::max(1, static_cast<int>(std::lround(keypoint.scale)));
  // Corners lie between pixels: a wavelet around pixel (x, y) is centred at its top left corner.
  const int x0 = static_cast<int>(std::lround(keypoint.x)) + kMargin - (kNodes / 2) * step;
  const int y0 = static_cast<int>(std::lround(keypoint.y)) + kMargin - (kNodes / 2) * step;
  Grid grid;
  for (int j = 0; j < kNodes; ++j) {
    const int y = std::clamp(y0 + j * step, 0, integral.height());
    for (int i = 0; i < kNodes; ++i) {
      const int x = std::clamp(x0 + i * step, 0, integral.width());
      grid[j][i] = static_cast<std::int32_t>(integral.at(y, x));
    }
    std::fill(grid[j].begin() + kNodes, grid[j].end(), 0);
  }
  Responses responses;
  fill_responses(grid, weights(), responses);
  // Samples whose corners were not moved.
  const auto first = [&](int origin) { return std::max(0, (step - 1 - origin) / step); };
  const auto last = [&](int origin, int size) {
    return std::min(kSide - 1, (size - origin) / step - 4);
  };
  return strongest_sector(responses, first(y0), last(y0, integral.height()), first(x0),
                          last(x0, integral.width()));
}

}  // namespace posevote::surf
