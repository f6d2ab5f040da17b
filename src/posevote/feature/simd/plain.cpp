#include <algorithm>
#include <cmath>

#include "posevote/feature/simd/kernels.hpp"

namespace posevote::simd {

const DescriptorWeights& descriptor_weights() {
  static const DescriptorWeights weights = [] {
    DescriptorWeights made{};
    const auto gauss = [](double off) { return std::exp(-off * off / (2 * 1.5 * 1.5)); };
    for (int i = 0; i < kSquareTaps; ++i) made.taps[i] = static_cast<float>(gauss(i - 2.5));
    for (int i = 0; i < 4; ++i) made.squares[i] = static_cast<float>(gauss(i - 1.5));
    return made;
  }();
  return weights;
}

const WaveletWeights& wavelet_weights() {
  static const WaveletWeights weights = [] {
    WaveletWeights made{};
    for (int j = 0; j < kWaveletSide; ++j)
      for (int i = 0; i < kWaveletSide; ++i) {
        const double x = i - 3.5, y = j - 3.5;
        made.at[j][i] = static_cast<float>(std::exp(-(x * x + y * y) / (2 * 2.0 * 2.0)));
      }
    return made;
  }();
  return weights;
}

namespace plain {
namespace {

int angle_bin(float x, float y) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float q = std::min(ax, ay) / (std::max(ax, ay) + 1e-30F), q2 = q * q;
  float angle = q * (kAtan[0] + q2 * (kAtan[1] + q2 * (kAtan[2] - q2 * kAtan[3])));
  if (ay > ax) angle = kBinsPerTurn / 4 - angle;
  if (x < 0) angle = kBinsPerTurn / 2 - angle;
  if (y < 0) angle = kBinsPerTurn - angle;
  return std::min<int>(static_cast<int>(angle), kAngleBins - 1);
}

// Sum of the closed range around (x, y); differences of wrapped sums are exact.
std::int32_t box(const SumsView& view, int x0, int y0, int x1, int y1) {
  const std::uint32_t* top = view.sums + y0 * view.stride;
  const std::uint32_t* bottom = view.sums + (y1 + 1) * view.stride;
  return static_cast<std::int32_t>(bottom[x1 + 1] - bottom[x0] - top[x1 + 1] + top[x0]);
}

float determinant(const SumsView& view, int x, int y, int lobe, float norm) {
  const int half = lobe + lobe / 2, middle = lobe / 2, wide = lobe - 1;
  const std::int32_t xx = box(view, x - half, y - wide, x + half, y + wide) -
                          3 * box(view, x - middle, y - wide, x + middle, y + wide);
  const std::int32_t yy = box(view, x - wide, y - half, x + wide, y + half) -
                          3 * box(view, x - wide, y - middle, x + wide, y + middle);
  const std::int32_t xy =
      box(view, x - lobe, y - lobe, x - 1, y - 1) + box(view, x + 1, y + 1, x + lobe, y + lobe) -
      box(view, x + 1, y - lobe, x + lobe, y - 1) - box(view, x - lobe, y + 1, x - 1, y + lobe);
  const float fxx = static_cast<float>(xx) * norm, fyy = static_cast<float>(yy) * norm;
  const float fxy = static_cast<float>(xy) * norm;
  return fxx * fyy - fxy * fxy * 0.81F;
}

}  // namespace

void smooth_row(const std::uint8_t* const rows[5], int count, std::uint16_t* scratch,
                std::uint8_t* out) {
  for (int x = -2; x < count + 2; ++x)
    scratch[x + 2] = static_cast<std::uint16_t>(rows[0][x] + rows[4][x] +
                                                4 * (rows[1][x] + rows[3][x]) + 6 * rows[2][x]);
  for (int x = 0; x < count; ++x) {
    const std::uint16_t* t = scratch + x;
    out[x] = static_cast<std::uint8_t>((t[0] + t[4] + 4 * (t[1] + t[3]) + 6 * t[2] + 128) >> 8);
  }
}

void integral_row(const std::uint8_t* pixels, const std::uint32_t* above, int count,
                  std::uint32_t* out) {
  std::uint32_t sum = 0;
  for (int x = 0; x < count; ++x) {
    sum += pixels[x];
    out[x] = above[x] + sum;
  }
}

void hessian_row(const SumsView& view, int x, int y, int count, const FilterPair& filters,
                 float* out) {
  for (int i = 0; i < count; ++i) {
    out[i] = determinant(view, x + i, y, filters.lobe[0], filters.norm[0]);
    if (filters.lobe[1] > 0)
      out[i] = std::max(out[i], determinant(view, x + i, y, filters.lobe[1], filters.norm[1]));
  }
}

void hessian_patch(const SumsView& view, int x, int y, int lobe, float norm, float* out) {
  for (int k = 0; k < 9; ++k) out[k] = determinant(view, x + k % 3 - 1, y + k / 3 - 1, lobe, norm);
}

int find_peaks(const float* const rows[3], int count, float threshold, int* columns) {
  int found = 0;
  for (int x = 1; x + 1 < count; ++x) {
    const float centre = rows[1][x];
    bool is_peak = centre >= threshold;
    for (int k = 0; k < 9 && is_peak; ++k) {
      const float other = rows[k / 3][x + k % 3 - 1];
      if (k < 4 ? other > centre : k > 4 && other >= centre) is_peak = false;
    }
    if (is_peak) columns[found++] = x;
  }
  return found;
}

void descriptor(const SumsView& view, const PatchFrame& frame, float* out) {
  float patch[kPatchNodes][kPatchNodes];
  const float shift = static_cast<float>(frame.side - 1) / 2;
  constexpr float kMiddle = (kPatchNodes - 1) / 2.0F;
  for (int j = 0; j < kPatchNodes; ++j)
    for (int i = 0; i < kPatchNodes; ++i) {
      const float u = static_cast<float>(i) - kMiddle, v = static_cast<float>(j) - kMiddle;
      const float x = frame.x - shift - v * frame.sine + u * frame.cosine;
      const float y = frame.y - shift + v * frame.cosine + u * frame.sine;
      const int x0 = std::clamp(static_cast<int>(std::lrint(x)), 0, view.width - frame.side);
      const int y0 = std::clamp(static_cast<int>(std::lrint(y)), 0, view.height - frame.side);
      patch[j][i] = static_cast<float>(box(view, x0, y0, x0 + frame.side - 1, y0 + frame.side - 1));
    }
  const DescriptorWeights& weights = descriptor_weights();
  float squares = 0;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      float sums[4] = {};
      for (int b = 0; b < kSquareTaps; ++b)
        for (int a = 0; a < kSquareTaps; ++a) {
          const int j = kSquareStep * row + b, i = kSquareStep * column + a;
          const float weight = weights.taps[a] * weights.taps[b];
          const float dx =
              weight * (patch[j][i + 1] + patch[j + 1][i + 1] - patch[j][i] - patch[j + 1][i]);
          const float dy =
              weight * (patch[j + 1][i] + patch[j + 1][i + 1] - patch[j][i] - patch[j][i + 1]);
          sums[0] += dx;
          sums[1] += dy;
          sums[2] += std::abs(dx);
          sums[3] += std::abs(dy);
        }
      for (int k = 0; k < 4; ++k) {
        const float value = sums[k] * weights.squares[row] * weights.squares[column];
        out[(row * 4 + column) * 4 + k] = value;
        squares += value * value;
      }
    }
  for (int i = 0; i < kDescriptorSize; ++i)
    out[i] = squares > 0 ? out[i] / std::sqrt(squares) : 0.125F;
}

int sector_sums(const WaveletGrid& grid, const WaveletRange& range, float* pairs) {
  float bins[kAngleBins][2] = {};
  for (int j = range.first_row; j <= range.last_row; ++j)
    for (int i = range.first_column; i <= range.last_column; ++i) {
      const float weight = wavelet_weights().at[j][i];
      const auto box = [&](int y0, int x0, int y1, int x1) {
        return grid.sums[j + y1][i + x1] - grid.sums[j + y1][i + x0] - grid.sums[j + y0][i + x1] +
               grid.sums[j + y0][i + x0];
      };
      const float dx = static_cast<float>(box(0, 2, 4, 4) - box(0, 0, 4, 2)) * weight;
      const float dy = static_cast<float>(box(2, 0, 4, 4) - box(0, 0, 2, 4)) * weight;
      bins[angle_bin(dx, dy)][0] += dx;
      bins[angle_bin(dx, dy)][1] += dy;
    }
  int longest = 0;
  float most = -1;
  for (int bin = 0; bin < kAngleBins; ++bin) {
    float x = 0, y = 0;
    for (int k = bin; k < bin + kSectorBins; ++k) {
      x += bins[k % kAngleBins][0];
      y += bins[k % kAngleBins][1];
    }
    *pairs++ = x;
    *pairs++ = y;
    if (x * x + y * y > most) {
      most = x * x + y * y;
      longest = bin;
    }
  }
  return longest;
}

}  // namespace plain
}  // namespace posevote::simd
