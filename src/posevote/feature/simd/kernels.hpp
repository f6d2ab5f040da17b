// The inner loops of SURF. `simd::` picks the best instruction set of the running CPU (AVX-512,
// AVX2, SSE4, NEON, ... from one source, by Highway); `simd::plain::` is the same in plain loops,
// and the contract: both give the same numbers (`descriptor` and `sector_sums` up to rounding).
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

/// Kernels read up to this many numbers past what they need, and write as many past their result.
inline constexpr int kSlack = 16;

/// One or two filters of the Hessian, each of size 3 * lobe, lobe odd and at most kLargestLobe.
struct FilterPair {
  int lobe[2];    ///< px; the second one is 0 when there is no second filter
  float norm[2];  ///< what each second derivative is multiplied by
};
inline constexpr int kLargestLobe = 21;

/// A square of 16 x 16 boxes around (x, y), turned and scaled.
struct PatchFrame {
  float x, y;          ///< px in the summed picture
  float cosine, sine;  ///< of the angle, times the distance of two boxes in px
  int side;            ///< px, of the boxes; at most the picture's own sides
};

inline constexpr std::ptrdiff_t kPatchNodes = 16;  ///< boxes along one side
inline constexpr int kDescriptorSize = 64;

/// Binomial filter 1 4 6 4 1 (sigma 1 px) both ways, rounded: `rows` are five rows of which the
/// middle one is filtered; they are read from -2 to count + 1. `scratch` holds count + 36 numbers.
void smooth_row(const std::uint8_t* const rows[5], int count, std::uint16_t* scratch,
                std::uint8_t* out);

/// out[x] = above[x] + pixels[0] + ... + pixels[x].
void integral_row(const std::uint8_t* pixels, const std::uint32_t* above, int count,
                  std::uint32_t* out);

/// The larger determinant of the box-filter Hessian of the two filters, at the pixels (x, y) ...
/// (x + count - 1, y). Precondition: the filters lie in the picture. Reads and writes kSlack more.
void hessian_row(const SumsView& view, int x, int y, int count, const FilterPair& filters,
                 float* out);

/// out[3 * j + i]: the determinant at (x + i - 1, y + j - 1) of one filter. Precondition: the
/// filters lie in the picture. Reads kSlack more.
void hessian_patch(const SumsView& view, int x, int y, int lobe, float norm, float* out);

/// Columns 1 ... count - 2 whose value in rows[1] is at least `threshold` and larger than its eight
/// neighbours', or as large as those above and to the left: of equal ones the last is taken. rows:
/// the top one first. Returns how many there are.
int find_peaks(const float* const rows[3], int count, float threshold, int* columns);

/// The 64 numbers described in surf/descriptor.hpp, of length 1.
void descriptor(const SumsView& view, const PatchFrame& frame, float* out);

/// Haar wavelets at 8 x 8 points: point (i, j) has its corners at the nodes [j], [j + 2], [j + 4] x
/// [i], [i + 2], [i + 4] of the grid of sums.
inline constexpr int kWaveletSide = 8, kWaveletNodes = 12;
struct WaveletGrid {
  std::int32_t sums[kWaveletNodes][kWaveletNodes];
};
/// The points that count, closed ranges within 0 ... 7.
struct WaveletRange {
  int first_row, last_row, first_column, last_column;
};
inline constexpr std::ptrdiff_t kAngleBins = 72, kSectorBins = 12;  ///< 5 and 60 degrees

/// (pairs[2 b], pairs[2 b + 1]): the sum of the weighted wavelet responses (dx, dy) of the points
/// whose angle lies in the bins b ... b + 11, modulo 72, for all 72. The angle is a polynomial of
/// at most 0.002 bins error. Returns the b of the longest sum, the first of equals.
int sector_sums(const WaveletGrid& grid, const WaveletRange& range, float* pairs);

namespace plain {
void smooth_row(const std::uint8_t* const rows[5], int count, std::uint16_t* scratch,
                std::uint8_t* out);
void integral_row(const std::uint8_t* pixels, const std::uint32_t* above, int count,
                  std::uint32_t* out);
void hessian_row(const SumsView& view, int x, int y, int count, const FilterPair& filters,
                 float* out);
void hessian_patch(const SumsView& view, int x, int y, int lobe, float norm, float* out);
int find_peaks(const float* const rows[3], int count, float threshold, int* columns);
void descriptor(const SumsView& view, const PatchFrame& frame, float* out);
int sector_sums(const WaveletGrid& grid, const WaveletRange& range, float* pairs);
}  // namespace plain

/// Weights of the descriptor: a square of 6 x 6 samples has the taps w[i] * w[j] (sigma 1.5
/// samples), the square (row, column) of the 4 x 4 the weight v[row] * v[column] (sigma 1.5
/// squares). A square begins three samples after the one before.
inline constexpr int kSquareTaps = 6, kSquareStep = 3;
struct DescriptorWeights {
  float taps[kSquareTaps];
  float squares[4];
};
[[nodiscard]] const DescriptorWeights& descriptor_weights();

/// Gaussian of sigma 2 points around the middle of the 8 x 8.
struct WaveletWeights {
  float at[kWaveletSide][kWaveletSide];
};
[[nodiscard]] const WaveletWeights& wavelet_weights();

/// atan(q) for 0 <= q <= 1 in bins: q (a0 + q2 (a1 + q2 (a2 - q2 a3))), q2 = q q.
inline constexpr float kBinsPerTurn = kAngleBins;
inline constexpr float kBinsPerRadian = kBinsPerTurn / 6.2831853F;
inline constexpr float kAtan[4] = {0.99921406F * kBinsPerRadian, -0.32117540F * kBinsPerRadian,
                                   0.14626446F * kBinsPerRadian, 0.03898651F * kBinsPerRadian};

}  // namespace posevote::simd
