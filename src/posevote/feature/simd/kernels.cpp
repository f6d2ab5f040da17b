#include "posevote/feature/simd/kernels.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "posevote/feature/simd/kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace posevote::simd {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void SmoothRow(const std::uint8_t* const* HWY_RESTRICT rows, int count,
               std::uint16_t* HWY_RESTRICT scratch, std::uint8_t* HWY_RESTRICT out) {
  const hn::CappedTag<std::uint16_t, 32> d16;
  const hn::RebindToSigned<decltype(d16)> di16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const int lanes = static_cast<int>(hn::Lanes(d16));
  const auto six = hn::Set(d16, 6);
  int x = -2;
  for (; x + lanes <= count + 2; x += lanes) {
    const auto pixels = [&](int row) { return hn::PromoteTo(d16, hn::LoadU(d8, rows[row] + x)); };
    const auto outer = hn::Add(pixels(0), pixels(4));
    const auto inner = hn::ShiftLeft<2>(hn::Add(pixels(1), pixels(3)));
    hn::StoreU(hn::Add(hn::Add(outer, inner), hn::Mul(pixels(2), six)), d16, scratch + x + 2);
  }
  for (; x < count + 2; ++x)
    scratch[x + 2] = static_cast<std::uint16_t>(rows[0][x] + rows[4][x] +
                                                4 * (rows[1][x] + rows[3][x]) + 6 * rows[2][x]);
  const auto half = hn::Set(d16, 128);
  for (x = 0; x + lanes <= count; x += lanes) {
    const auto sums = [&](int i) { return hn::LoadU(d16, scratch + x + i); };
    const auto outer = hn::Add(sums(0), sums(4));
    const auto inner = hn::ShiftLeft<2>(hn::Add(sums(1), sums(3)));
    const auto total = hn::Add(hn::Add(outer, inner), hn::Add(hn::Mul(sums(2), six), half));
    hn::StoreU(hn::DemoteTo(d8, hn::BitCast(di16, hn::ShiftRight<8>(total))), d8, out + x);
  }
  for (; x < count; ++x) {
    const std::uint16_t* t = scratch + x;
    out[x] = static_cast<std::uint8_t>((t[0] + t[4] + 4 * (t[1] + t[3]) + 6 * t[2] + 128) >> 8);
  }
}

// The running sum inside groups of four lanes by two shifted additions; the carry over the groups
// is the only chain from one vector to the next.
void IntegralRow(const std::uint8_t* HWY_RESTRICT pixels, const std::uint32_t* HWY_RESTRICT above,
                 int count, std::uint32_t* HWY_RESTRICT out) {
  std::uint32_t sum = 0;
  int x = 0;
#if HWY_TARGET != HWY_SCALAR
  const hn::FixedTag<std::uint32_t, 4> d;
  const hn::FixedTag<std::uint8_t, 4> d8;
  auto carry = hn::Zero(d);
  for (; x + 4 <= count; x += 4) {
    auto run = hn::PromoteTo(d, hn::LoadU(d8, pixels + x));
    run = hn::Add(run, hn::ShiftLeftLanes<1>(d, run));
    run = hn::Add(run, hn::ShiftLeftLanes<2>(d, run));
    hn::StoreU(hn::Add(hn::Add(run, carry), hn::LoadU(d, above + x)), d, out + x);
    carry = hn::Add(carry, hn::Broadcast<3>(run));
  }
  sum = hn::GetLane(carry);
#endif
  for (; x < count; ++x) {
    sum += pixels[x];
    out[x] = above[x] + sum;
  }
}

// The filters are separable into differences of sums along y, which neighbours in x share, and then
// along x: 20 loads per vector instead of 32. A tile's rows of differences stay in the L1 cache.
constexpr int kTile = 512;
constexpr int kTileReach = 3 * kLargestLobe + 1;  // of the largest filter, both sides together

struct Differences {
  std::int32_t xx[kTile + kTileReach + kSlack], yy[kTile + kTileReach + kSlack],
      xy[kTile + kTileReach + kSlack];
};

// `at`: the sum at the row above the centre and the tile's first column.
template <class D>
HWY_INLINE void DifferencesAlongY(D d, const std::int32_t* HWY_RESTRICT at, std::ptrdiff_t stride,
                                  int lobe, int count, Differences& out) {
  const int middle = lobe / 2, half = lobe + middle, wide = lobe - 1;
  for (int x = 0; x < count; x += static_cast<int>(hn::Lanes(d))) {
    const auto sums = [&](int y) HWY_ATTR { return hn::LoadU(d, at + y * stride + x); };
    hn::StoreU(hn::Sub(sums(wide + 1), sums(-wide)), d, out.xx + x);
    const auto inner = hn::Sub(sums(middle + 1), sums(-middle));
    const auto outer = hn::Sub(sums(half + 1), sums(-half));
    hn::StoreU(hn::Sub(outer, hn::Add(inner, hn::Add(inner, inner))), d, out.yy + x);
    const auto below = hn::Sub(sums(lobe + 1), sums(1)), above = hn::Sub(sums(0), sums(-lobe));
    hn::StoreU(hn::Sub(below, above), d, out.xy + x);
  }
}

template <class D>
HWY_INLINE hn::Vec<hn::RebindToFloat<D>> Determinants(D /*d*/, hn::Vec<D> xx, hn::Vec<D> yy,
                                                      hn::Vec<D> xy, float norm) {
  const hn::RebindToFloat<D> df;
  const auto fxx = hn::Mul(hn::ConvertTo(df, xx), hn::Set(df, norm));
  const auto fyy = hn::Mul(hn::ConvertTo(df, yy), hn::Set(df, norm));
  const auto fxy = hn::Mul(hn::ConvertTo(df, xy), hn::Set(df, norm));
  return hn::Sub(hn::Mul(fxx, fyy), hn::Mul(hn::Mul(fxy, fxy), hn::Set(df, 0.81F)));
}

// `x`: of the filter's centre in the tile's rows.
template <class D>
HWY_INLINE hn::Vec<hn::RebindToFloat<D>> DeterminantsAlongX(D d, const Differences& in, int x,
                                                            int lobe, float norm) {
  const int middle = lobe / 2, half = lobe + middle, wide = lobe - 1;
  const auto range = [&](const std::int32_t* row, int from, int to) HWY_ATTR {
    return hn::Sub(hn::LoadU(d, row + x + to), hn::LoadU(d, row + x + from));
  };
  const auto inner = range(in.xx, -middle, middle + 1);
  const auto xx = hn::Sub(range(in.xx, -half, half + 1), hn::Add(inner, hn::Add(inner, inner)));
  const auto yy = range(in.yy, -wide, wide + 1);
  const auto xy = hn::Sub(range(in.xy, 1, lobe + 1), range(in.xy, -lobe, 0));
  return Determinants(d, xx, yy, xy, norm);
}

// Lobes known to the compiler spare the registers that their places would take.
template <int kFirst = 0, int kSecond = 0>
void HessianTile(const std::int32_t* HWY_RESTRICT at, std::ptrdiff_t stride, int count,
                 const FilterPair& filters, float* HWY_RESTRICT out) {
  const hn::CappedTag<std::int32_t, kSlack> d;
  const hn::RebindToFloat<decltype(d)> df;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int first = kFirst ? kFirst : filters.lobe[0], second = kSecond ? kSecond : filters.lobe[1];
  const auto half = [](int lobe) { return lobe + lobe / 2; };
  HWY_ALIGN Differences rows[2];
  DifferencesAlongY(d, at - half(first), stride, first, count + 2 * half(first) + 1, rows[0]);
  if (second)
    DifferencesAlongY(d, at - half(second), stride, second, count + 2 * half(second) + 1, rows[1]);
  for (int x = 0; x < count; x += lanes) {
    auto most = DeterminantsAlongX(d, rows[0], x + half(first), first, filters.norm[0]);
    if (second)
      most =
          hn::Max(most, DeterminantsAlongX(d, rows[1], x + half(second), second, filters.norm[1]));
    hn::StoreU(most, df, out + x);
  }
}

void HessianRow(const SumsView& view, int x, int y, int count, const FilterPair& filters,
                float* HWY_RESTRICT out) {
  const auto* at = reinterpret_cast<const std::int32_t*>(view.sums) + y * view.stride + x;
  const bool usual = filters.lobe[0] == 5 && filters.lobe[1] == 7;
  for (int i = 0; i < count; i += kTile) {
    const int width = std::min(kTile, count - i);
    if (usual)
      HessianTile<5, 7>(at + i, view.stride, width, filters, out + i);
    else
      HessianTile(at + i, view.stride, width, filters, out + i);
  }
}

void HessianPatch(const SumsView& view, int x, int y, int lobe, float norm,
                  float* HWY_RESTRICT out) {
#if HWY_TARGET == HWY_SCALAR
  plain::hessian_patch(view, x, y, lobe, norm, out);
#else
  const hn::FixedTag<std::int32_t, 4> d;
  const hn::RebindToFloat<decltype(d)> df;
  const int middle = lobe / 2, half = lobe + middle, wide = lobe - 1;
  const auto* at = reinterpret_cast<const std::int32_t*>(view.sums) + (y - 1) * view.stride + x - 1;
  float patch[12];
  for (std::ptrdiff_t row = 0; row < 3; ++row, at += view.stride) {
    const auto range = [&](int j, int from, int to) HWY_ATTR {
      const std::int32_t* line = at + j * view.stride;
      return hn::Sub(hn::LoadU(d, line + to), hn::LoadU(d, line + from));
    };
    const auto box = [&](int x0, int y0, int x1, int y1)
                         HWY_ATTR { return hn::Sub(range(y1, x0, x1), range(y0, x0, x1)); };
    const auto thrice = [](auto v) HWY_ATTR { return hn::Add(v, hn::Add(v, v)); };
    const auto xx = hn::Sub(box(-half, -wide, half + 1, wide + 1),
                            thrice(box(-middle, -wide, middle + 1, wide + 1)));
    const auto yy = hn::Sub(box(-wide, -half, wide + 1, half + 1),
                            thrice(box(-wide, -middle, wide + 1, middle + 1)));
    const auto same = hn::Add(box(-lobe, -lobe, 0, 0), box(1, 1, lobe + 1, lobe + 1));
    const auto opposite = hn::Add(box(1, -lobe, lobe + 1, 0), box(-lobe, 1, 0, lobe + 1));
    hn::StoreU(Determinants(d, xx, yy, hn::Sub(same, opposite), norm), df, patch + 4 * row);
  }
  for (int k = 0; k < 9; ++k) out[k] = patch[k / 3 * 4 + k % 3];
#endif
}

template <class D>
HWY_INLINE hn::Mask<D> PeakMask(D d, const float* const* rows, int x, hn::Vec<D> threshold) {
  const auto centre = hn::LoadU(d, rows[1] + x);
  const auto at = [&](int row, int shift) HWY_ATTR { return hn::LoadU(d, rows[row] + x + shift); };
  // Five tests before the first branch: threshold alone is a coin toss on textured ground.
  auto mask = hn::And(hn::Ge(centre, threshold), hn::Ge(centre, at(1, -1)));
  mask = hn::And(mask, hn::And(hn::Gt(centre, at(1, 1)), hn::Ge(centre, at(0, 0))));
  mask = hn::And(mask, hn::Gt(centre, at(2, 0)));
  if (HWY_LIKELY(hn::AllFalse(d, mask))) return mask;
  mask = hn::And(mask, hn::And(hn::Ge(centre, at(0, -1)), hn::Ge(centre, at(0, 1))));
  return hn::And(mask, hn::And(hn::Gt(centre, at(2, -1)), hn::Gt(centre, at(2, 1))));
}

int FindPeaks(const float* const* HWY_RESTRICT rows, int count, float threshold,
              int* HWY_RESTRICT columns) {
  const hn::ScalableTag<float> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int found = 0, x = 1;
  for (; x + lanes + 1 <= count; x += lanes) {
    const auto mask = PeakMask(d, rows, x, hn::Set(d, threshold));
    if (HWY_LIKELY(hn::AllFalse(d, mask))) continue;
    std::uint8_t bits[32] = {};
    hn::StoreMaskBits(d, mask, bits);
    for (int i = 0; i < lanes; ++i)
      if (bits[i / 8] & (1 << (i % 8))) columns[found++] = x + i;
  }
  const hn::CappedTag<float, 1> one;
  for (; x + 1 < count; ++x)
    if (!hn::AllFalse(one, PeakMask(one, rows, x, hn::Set(one, threshold)))) columns[found++] = x;
  return found;
}

// Where the boxes of all nodes begin among the sums; those outside are moved to the border.
template <bool kInside>
HWY_INLINE void NodeIndices(const SumsView& view, const PatchFrame& frame,
                            std::int32_t* HWY_RESTRICT index) {
  const hn::CappedTag<float, kPatchNodes> d;
  const hn::RebindToSigned<decltype(d)> di;
  constexpr float kMiddle = (kPatchNodes - 1) / 2.0F;
  const float shift = static_cast<float>(frame.side - 1) / 2;
  const float left = frame.x - shift, top = frame.y - shift;
  const auto right_end = hn::Set(di, view.width - frame.side), zero = hn::Zero(di);
  const auto bottom_end = hn::Set(di, view.height - frame.side);
  const auto stride = hn::Set(di, static_cast<std::int32_t>(view.stride));
  for (int i = 0; i < kPatchNodes; i += static_cast<int>(hn::Lanes(d))) {
    const auto u = hn::Iota(d, static_cast<float>(i) - kMiddle);
    const auto along_x = hn::Mul(u, hn::Set(d, frame.cosine));
    const auto along_y = hn::Mul(u, hn::Set(d, frame.sine));
    for (int j = 0; j < kPatchNodes; ++j) {
      const float v = static_cast<float>(j) - kMiddle;
      auto x = hn::NearestInt(hn::Add(hn::Set(d, left - v * frame.sine), along_x));
      auto y = hn::NearestInt(hn::Add(hn::Set(d, top + v * frame.cosine), along_y));
      if (!kInside) {
        x = hn::Min(hn::Max(x, zero), right_end);
        y = hn::Min(hn::Max(y, zero), bottom_end);
      }
      hn::Store(hn::Add(hn::Mul(y, stride), x), di, index + j * kPatchNodes + i);
    }
  }
}

// Plain loads: a gather of eight takes 50 cycles on Zen 3, the eight loads 4 to 8.
HWY_INLINE void SamplePatch(const SumsView& view, const PatchFrame& frame,
                            float* HWY_RESTRICT patch) {
  constexpr int kNodes = kPatchNodes * kPatchNodes;
  alignas(64) std::int32_t index[kNodes], sums[kNodes];
  const float reach =  // of the outermost boxes, and a pixel for rounding
      (kPatchNodes - 1) / 2.0F * (std::abs(frame.cosine) + std::abs(frame.sine)) +
      static_cast<float>(frame.side) / 2 + 2;
  const bool inside = frame.x >= reach && frame.y >= reach &&
                      frame.x + reach <= static_cast<float>(view.width) &&
                      frame.y + reach <= static_cast<float>(view.height);
  if (HWY_LIKELY(inside))
    NodeIndices<true>(view, frame, index);
  else
    NodeIndices<false>(view, frame, index);
  const std::uint32_t* HWY_RESTRICT upper = view.sums;
  const std::uint32_t* HWY_RESTRICT lower = upper + frame.side * view.stride;
  const std::ptrdiff_t side = frame.side;
#pragma GCC unroll 4
  for (int k = 0; k < kNodes; ++k) {
    const std::ptrdiff_t at = index[k];
    sums[k] =
        static_cast<std::int32_t>(lower[at + side] - lower[at] - upper[at + side] + upper[at]);
  }
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  for (int k = 0; k < kNodes; k += static_cast<int>(hn::Lanes(d)))
    hn::Store(hn::ConvertTo(d, hn::Load(di, sums + k)), d, patch + k);
}

// Sums over six rows of samples, weighted: sums[4 * i + k] for column i and k of dx, dy, |dx|,
// |dy|.
HWY_INLINE void SumRows(const float* HWY_RESTRICT patch, float* HWY_RESTRICT sums) {
  const hn::CappedTag<float, kPatchNodes> d;
  const DescriptorWeights& weights = descriptor_weights();
  for (std::size_t i = 0; i < kPatchNodes; i += hn::Lanes(d)) {
    const float* at = patch + i;
    auto left = hn::LoadU(d, at), right = hn::LoadU(d, at + 1);
    auto dx_sum = hn::Zero(d), dy_sum = dx_sum, dx_abs = dx_sum, dy_abs = dx_sum;
    for (int tap = 0; tap < kSquareTaps; ++tap) {
      at += kPatchNodes;
      const auto below_left = hn::LoadU(d, at), below_right = hn::LoadU(d, at + 1);
      const auto falling = hn::Sub(below_right, left), rising = hn::Sub(right, below_left);
      const auto weight = hn::Set(d, weights.taps[tap]);
      const auto dx = hn::Add(falling, rising), dy = hn::Sub(falling, rising);
      dx_sum = hn::MulAdd(dx, weight, dx_sum);
      dy_sum = hn::MulAdd(dy, weight, dy_sum);
      dx_abs = hn::MulAdd(hn::Abs(dx), weight, dx_abs);
      dy_abs = hn::MulAdd(hn::Abs(dy), weight, dy_abs);
      left = below_left;
      right = below_right;
    }
    hn::StoreInterleaved4(dx_sum, dy_sum, dx_abs, dy_abs, d, sums + 4 * i);
  }
}

void Descriptor(const SumsView& view, const PatchFrame& frame, float* HWY_RESTRICT out) {
  // The last column has no right neighbour; what is read there is never used.
  alignas(64) float patch[kPatchNodes * kPatchNodes + kSlack];
  std::fill_n(patch + kPatchNodes * kPatchNodes, kSlack, 0.0F);
  SamplePatch(view, frame, patch);
  const hn::CappedTag<float, 4> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const DescriptorWeights& weights = descriptor_weights();
  auto squares = hn::Zero(d);
  for (std::ptrdiff_t row = 0; row < 4; ++row) {
    alignas(64) float sums[4 * kPatchNodes];
    SumRows(patch + kPatchNodes * kSquareStep * row, sums);
    for (std::ptrdiff_t column = 0; column < 4; ++column)
      for (int k = 0; k < 4; k += lanes) {
        const float* at = sums + column * kSquareStep * 4 + k;
        auto total = hn::Zero(d);
        for (std::ptrdiff_t tap = 0; tap < kSquareTaps; ++tap)
          total = hn::MulAdd(hn::Load(d, at + 4 * tap), hn::Set(d, weights.taps[tap]), total);
        total = hn::Mul(total, hn::Set(d, weights.squares[row] * weights.squares[column]));
        squares = hn::MulAdd(total, total, squares);
        hn::StoreU(total, d, out + (row * 4 + column) * 4 + k);
      }
  }
  const float length = std::sqrt(hn::GetLane(hn::SumOfLanes(d, squares)));
  if (!(length > 0)) {
    std::fill_n(out, kDescriptorSize, 0.125F);
    return;
  }
  const auto scale = hn::Set(d, 1 / length);
  for (int i = 0; i < kDescriptorSize; i += lanes)
    hn::StoreU(hn::Mul(hn::LoadU(d, out + i), scale), d, out + i);
}

// The bin of the angle of (x, y), see plain::sector_sums.
template <class D>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> AngleBin(D d, hn::Vec<D> x, hn::Vec<D> y) {
  const hn::RebindToSigned<D> di;
  const auto ax = hn::Abs(x), ay = hn::Abs(y), zero = hn::Zero(d);
  const auto q = hn::Div(hn::Min(ax, ay), hn::Add(hn::Max(ax, ay), hn::Set(d, 1e-30F)));
  const auto q2 = hn::Mul(q, q);
  auto angle = hn::Sub(hn::Set(d, kAtan[2]), hn::Mul(q2, hn::Set(d, kAtan[3])));
  angle = hn::Add(hn::Set(d, kAtan[1]), hn::Mul(q2, angle));
  angle = hn::Mul(q, hn::Add(hn::Set(d, kAtan[0]), hn::Mul(q2, angle)));
  angle = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(hn::Set(d, kBinsPerTurn / 4), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, zero), hn::Sub(hn::Set(d, kBinsPerTurn / 2), angle), angle);
  angle = hn::IfThenElse(hn::Lt(y, zero), hn::Sub(hn::Set(d, kBinsPerTurn), angle), angle);
  return hn::Min(hn::ConvertTo(di, angle), hn::Set(di, kAngleBins - 1));
}

// Weighted wavelet responses of one row of points as pairs (dx, dy), and the bins of their angles.
HWY_INLINE void Wavelets(const WaveletGrid& grid, int j, float* HWY_RESTRICT pairs,
                         std::int32_t* HWY_RESTRICT bins) {
  const hn::CappedTag<float, kWaveletSide> d;
  const hn::RebindToSigned<decltype(d)> di;
  for (std::size_t i = 0; i < kWaveletSide; i += hn::Lanes(d)) {
    const auto at = [&](int row, int column)
                        HWY_ATTR { return hn::LoadU(di, grid.sums[j + row] + i + column); };
    const auto left = hn::Sub(at(4, 0), at(0, 0)), right = hn::Sub(at(4, 4), at(0, 4));
    const auto centre = hn::Sub(at(4, 2), at(0, 2)), middle = hn::Sub(at(2, 4), at(2, 0));
    const auto top = hn::Sub(at(0, 4), at(0, 0)), bottom = hn::Sub(at(4, 4), at(4, 0));
    const auto twice = [](auto v) HWY_ATTR { return hn::Add(v, v); };
    const auto weight = hn::LoadU(d, wavelet_weights().at[j] + i);
    const auto dx = hn::Sub(hn::Add(left, right), twice(centre));
    const auto dy = hn::Sub(hn::Add(top, bottom), twice(middle));
    const auto x = hn::Mul(hn::ConvertTo(d, dx), weight);
    const auto y = hn::Mul(hn::ConvertTo(d, dy), weight);
    hn::StoreInterleaved2(x, y, d, pairs + 2 * i);
    hn::Store(AngleBin(d, x, y), di, bins + i);
  }
}

int SectorSums(const WaveletGrid& grid, const WaveletRange& range, float* HWY_RESTRICT pairs) {
  const hn::CappedTag<float, 8> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  // Two histograms in turns, as neighbours often fall into the same bin and would wait for each
  // other; room for what runs over the end when sums of neighbours are taken.
  constexpr int kRoom = 2 * (kAngleBins + 24);
  alignas(64) float sums[2][kRoom] = {};
  for (int j = range.first_row; j <= range.last_row; ++j) {
    alignas(64) float responses[2 * kWaveletSide];
    alignas(64) std::int32_t bins[kWaveletSide];
    Wavelets(grid, j, responses, bins);
    for (std::ptrdiff_t i = range.first_column; i <= range.last_column; ++i) {
      const std::ptrdiff_t bin = bins[i];
      float* at = sums[i % 2] + 2 * bin;
      at[0] += responses[2 * i];
      at[1] += responses[2 * i + 1];
    }
  }
  const auto join = [&](const float* a, const float* b, float* to, int bins) HWY_ATTR {
    for (int i = 0; i < 2 * bins; i += lanes)
      hn::StoreU(hn::Add(hn::LoadU(d, a + i), hn::LoadU(d, b + i)), d, to + i);
  };
  alignas(64) float two[kRoom], four[kRoom];
  join(sums[0], sums[1], sums[0], kAngleBins);
  std::copy_n(sums[0], 2 * kSectorBins, sums[0] + 2 * kAngleBins);
  join(sums[0], sums[0] + 2, two, kAngleBins + 16);
  join(two, two + 4, four, kAngleBins + 8);
  join(four, four + 8, two, kAngleBins);    // eight
  join(two, four + 16, pairs, kAngleBins);  // twelve
  float lengths[kAngleBins];
  for (std::ptrdiff_t b = 0; b < kAngleBins; ++b)
    lengths[b] = pairs[2 * b] * pairs[2 * b] + pairs[2 * b + 1] * pairs[2 * b + 1];
  auto most = hn::LoadU(d, lengths);
  for (int b = lanes; b < kAngleBins; b += lanes) most = hn::Max(most, hn::LoadU(d, lengths + b));
  const float longest = hn::GetLane(hn::MaxOfLanes(d, most));
  int b = 0;
  while (b + 1 < kAngleBins && lengths[b] != longest) ++b;
  return b;
}

}  // namespace HWY_NAMESPACE
}  // namespace posevote::simd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace posevote::simd {

HWY_EXPORT(SmoothRow);
HWY_EXPORT(IntegralRow);
HWY_EXPORT(HessianRow);
HWY_EXPORT(HessianPatch);
HWY_EXPORT(FindPeaks);
HWY_EXPORT(Descriptor);
HWY_EXPORT(SectorSums);

void smooth_row(const std::uint8_t* const rows[5], int count, std::uint16_t* scratch,
                std::uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(SmoothRow)(rows, count, scratch, out);
}

void integral_row(const std::uint8_t* pixels, const std::uint32_t* above, int count,
                  std::uint32_t* out) {
  HWY_DYNAMIC_DISPATCH(IntegralRow)(pixels, above, count, out);
}

void hessian_row(const SumsView& view, int x, int y, int count, const FilterPair& filters,
                 float* out) {
  HWY_DYNAMIC_DISPATCH(HessianRow)(view, x, y, count, filters, out);
}

void hessian_patch(const SumsView& view, int x, int y, int lobe, float norm, float* out) {
  HWY_DYNAMIC_DISPATCH(HessianPatch)(view, x, y, lobe, norm, out);
}

int find_peaks(const float* const rows[3], int count, float threshold, int* columns) {
  return HWY_DYNAMIC_DISPATCH(FindPeaks)(rows, count, threshold, columns);
}

void descriptor(const SumsView& view, const PatchFrame& frame, float* out) {
  HWY_DYNAMIC_DISPATCH(Descriptor)(view, frame, out);
}

int sector_sums(const WaveletGrid& grid, const WaveletRange& range, float* pairs) {
  return HWY_DYNAMIC_DISPATCH(SectorSums)(grid, range, pairs);
}

}  // namespace posevote::simd
#endif  // HWY_ONCE
