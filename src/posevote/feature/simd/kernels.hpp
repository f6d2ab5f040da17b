// The inner loops of SURF. `simd::` picks the best instruction set of the running CPU (AVX-512,
// AVX2, SSE4, NEON, ... from one source, by Highway); `simd::plain::` is the same in plain loops,
// and the contract: both give the same numbers (`descriptor` up to rounding).
#pragma once

#include <cstddef>
#include <cstdint>

namespace posevote::simd {

/// Sums of a picture, see surf/integral.hpp: sums[y * stride + x] is the sum above y and left of x.
struct SumsView {
  const std::uint32_t* sums;
  std::ptrdiff_t stride;
  int width, height;  ///< of the picture: sums has one more of each
};

/// A square of 24 x 24 samples around (x, y), turned and scaled.
struct PatchFrame {
  float x, y;          ///< px in the summed picture
  float cosine, sine;  ///< of the angle, times the distance of two samples in px
  int side;  ///< px, of the boxes whose means are sampled; at most the picture's own sides
};

/// Sums of all boxes of one side, at most 16 px: boxes[y * stride + x] is that of the box whose top
/// left pixel is (x, y). Null: not made, the sums are looked up instead, with the same result.
struct BoxesView {
  const std::uint16_t* boxes = nullptr;
  std::ptrdiff_t stride = 0;
};

inline constexpr int kPatchNodes = 25;  ///< corners of the 24 x 24 samples, along one side
inline constexpr int kDescriptorSize = 64;
inline constexpr int kMaximaRows = 9;

/// Binomial filter 1 4 6 4 1 (sigma 1 px) both ways, rounded: `rows` are five rows of which the
/// middle one is filtered; they are read from -2 to count + 1. `scratch` holds count + 36 numbers.
void smooth_row(const std::uint8_t* const rows[5], int count, std::uint16_t* scratch,
                std::uint8_t* out);

/// out[x] = above[x] + pixels[0] + ... + pixels[x].
void integral_row(const std::uint8_t* pixels, const std::uint32_t* above, int count,
                  std::uint32_t* out);

/// Determinants of the box-filter Hessian of size 3 * lobe at the pixels (x, y) ... (x + count - 1,
/// y); each second derivative is multiplied by `norm`. Precondition: the filters lie in the
/// picture.
void hessian_row(const SumsView& view, int x, int y, int count, int lobe, float norm, float* out);

/// Columns 1 ... count - 2 whose value in rows[4] is at least `threshold` and larger than its 26
/// neighbours; rows: three layers of three rows each, top row first. Returns how many there are.
int find_maxima(const float* const rows[kMaximaRows], int count, float threshold, int* columns);

/// The 64 numbers described in surf/descriptor.hpp, not yet normalised. `boxes`: of side
/// frame.side.
void descriptor(const SumsView& view, const BoxesView& boxes, const PatchFrame& frame, float* out);

/// out[x] = the sum of the box of `side` (at most 16) with the top left pixel (x, y), x < count.
void box_row(const SumsView& view, int y, int side, int count, std::uint16_t* out);

/// Haar wavelets at 11 x 11 points, the middle one in the middle: point (i, j) has its corners at
/// the nodes [j], [j + 2], [j + 4] x [i], [i + 2], [i + 4] of the grid of sums. Columns from 15 on
/// are padding.
inline constexpr int kWaveletSide = 11, kWaveletNodes = 15;
struct WaveletGrid {
  std::int32_t sums[kWaveletNodes][24];
};
/// The points that count, closed ranges within 0 ... 10.
struct WaveletRange {
  int first_row, last_row, first_column, last_column;
};
inline constexpr int kAngleBins = 72, kSectorBins = 12;  ///< 5 and 60 degrees

/// x[b], y[b]: the sum of the weighted wavelet responses (dx, dy) of the points within a circle
/// whose angle lies in the bins b ... b + 11, modulo 72; both have 72 numbers. The angle is a
/// polynomial of at most 0.002 bins error.
void sector_sums(const WaveletGrid& grid, const WaveletRange& range, float* x, float* y);

namespace plain {
void sector_sums(const WaveletGrid& grid, const WaveletRange& range, float* x, float* y);
void smooth_row(const std::uint8_t* const rows[5], int count, std::uint16_t* scratch,
                std::uint8_t* out);
void integral_row(const std::uint8_t* pixels, const std::uint32_t* above, int count,
                  std::uint32_t* out);
void hessian_row(const SumsView& view, int x, int y, int count, int lobe, float norm, float* out);
int find_maxima(const float* const rows[kMaximaRows], int count, float threshold, int* columns);
void descriptor(const SumsView& view, const PatchFrame& frame, float* out);
void box_row(const SumsView& view, int y, int side, int count, std::uint16_t* out);
}  // namespace plain

/// Weights of the descriptor: a square of 9 x 9 samples has the taps w[i] * w[j] (sigma 2.5), the
/// square (row, column) of the 4 x 4 the weight v[row] * v[column] (sigma 1.5 squares).
struct DescriptorWeights {
  float taps[9];
  float squares[4];
};
[[nodiscard]] const DescriptorWeights& descriptor_weights();

/// Gaussian of sigma 2.5 points, 0 outside the circle of radius 6; rows have 16 columns. Row j has
/// its points within `reach[j]` columns of the middle.
struct WaveletWeights {
  float at[kWaveletSide][16];
  int reach[kWaveletSide];
};
[[nodiscard]] const WaveletWeights& wavelet_weights();

/// atan(q) for 0 <= q <= 1 in bins: q (a0 + q2 (a1 + q2 (a2 - q2 a3))), q2 = q q.
inline constexpr float kBinsPerTurn = kAngleBins;
inline constexpr float kBinsPerRadian = kBinsPerTurn / 6.2831853F;
inline constexpr float kAtan[4] = {0.99921406F * kBinsPerRadian, -0.32117540F * kBinsPerRadian,
                                   0.14626446F * kBinsPerRadian, 0.03898651F * kBinsPerRadian};

}  // namespace posevote::simd
