#include "posevote/feature/simd/kernels.hpp"

#include <algorithm>

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
// along x: 20 loads per vector instead of 32. A tile's three rows of differences stay in the L1
// cache.
constexpr int kTile = 1024;
constexpr int kTileReach = 512;  // of the largest filter that is tiled, both sides together

struct Differences {
  std::int32_t xx[kTile + kTileReach], yy[kTile + kTileReach], xy[kTile + kTileReach];
};

// `at`: the sum at the row above the centre and the tile's first column.
template <class D>
HWY_INLINE void DifferencesAlongY(D d, const std::int32_t* HWY_RESTRICT at, std::ptrdiff_t stride,
                                  int lobe, int x, Differences& out) {
  const int middle = lobe / 2, half = lobe + middle, wide = lobe - 1;
  const auto sums = [&](int y) HWY_ATTR { return hn::LoadU(d, at + y * stride + x); };
  hn::StoreU(hn::Sub(sums(wide + 1), sums(-wide)), d, out.xx + x);
  const auto inner = hn::Sub(sums(middle + 1), sums(-middle));
  const auto outer = hn::Sub(sums(half + 1), sums(-half));
  hn::StoreU(hn::Sub(outer, hn::Add(inner, hn::Add(inner, inner))), d, out.yy + x);
  const auto below = hn::Sub(sums(lobe + 1), sums(1)), above = hn::Sub(sums(0), sums(-lobe));
  hn::StoreU(hn::Sub(below, above), d, out.xy + x);
}

// `x`: of the filter's centre in the tile's rows.
template <class D>
HWY_INLINE void DeterminantsAlongX(D d, const Differences& in, int x, int lobe, float norm,
                                   float* HWY_RESTRICT out) {
  const hn::RebindToFloat<D> df;
  const int middle = lobe / 2, half = lobe + middle, wide = lobe - 1;
  const auto range = [&](const std::int32_t* row, int from, int to) HWY_ATTR {
    return hn::Sub(hn::LoadU(d, row + x + to), hn::LoadU(d, row + x + from));
  };
  const auto inner = range(in.xx, -middle, middle + 1);
  const auto xx = hn::Sub(range(in.xx, -half, half + 1), hn::Add(inner, hn::Add(inner, inner)));
  const auto yy = range(in.yy, -wide, wide + 1);
  const auto xy = hn::Sub(range(in.xy, 1, lobe + 1), range(in.xy, -lobe, 0));
  const auto fxx = hn::Mul(hn::ConvertTo(df, xx), hn::Set(df, norm));
  const auto fyy = hn::Mul(hn::ConvertTo(df, yy), hn::Set(df, norm));
  const auto fxy = hn::Mul(hn::ConvertTo(df, xy), hn::Set(df, norm));
  hn::StoreU(hn::Sub(hn::Mul(fxx, fyy), hn::Mul(hn::Mul(fxy, fxy), hn::Set(df, 0.81F))), df, out);
}

void HessianTile(const std::int32_t* HWY_RESTRICT at, std::ptrdiff_t stride, int count, int lobe,
                 float norm, float* HWY_RESTRICT out) {
  const hn::ScalableTag<std::int32_t> d;
  const hn::CappedTag<std::int32_t, 1> one;
  const int lanes = static_cast<int>(hn::Lanes(d)), half = lobe + lobe / 2;
  const int total = count + 2 * half + 1;
  HWY_ALIGN Differences rows;
  int x = 0;
  for (; x + lanes <= total; x += lanes) DifferencesAlongY(d, at - half, stride, lobe, x, rows);
  for (; x < total; ++x) DifferencesAlongY(one, at - half, stride, lobe, x, rows);
  for (x = 0; x + lanes <= count; x += lanes)
    DeterminantsAlongX(d, rows, x + half, lobe, norm, out + x);
  for (; x < count; ++x) DeterminantsAlongX(one, rows, x + half, lobe, norm, out + x);
}

void HessianRow(const SumsView& view, int x, int y, int count, int lobe, float norm,
                float* HWY_RESTRICT out) {
  const auto* at = reinterpret_cast<const std::int32_t*>(view.sums) + y * view.stride + x;
  const int tile = kTile + kTileReach - 3 * lobe - 1;
  if (tile < 1) return plain::hessian_row(view, x, y, count, lobe, norm, out);
  for (int i = 0; i < count; i += tile)
    HessianTile(at + i, view.stride, std::min(tile, count - i), lobe, norm, out + i);
}

template <class D>
HWY_INLINE hn::Mask<D> MaximumMask(D d, const float* const* rows, int x, hn::Vec<D> threshold) {
  const auto centre = hn::LoadU(d, rows[4] + x);
  const auto above = [&](int row, int shift)
                         HWY_ATTR { return hn::Gt(centre, hn::LoadU(d, rows[row] + x + shift)); };
  // Five tests before the first branch: threshold alone is a coin toss on textured ground.
  auto mask = hn::And(hn::Ge(centre, threshold), hn::And(above(4, -1), above(4, 1)));
  mask = hn::And(mask, hn::And(above(3, 0), above(5, 0)));
  if (HWY_LIKELY(hn::AllFalse(d, mask))) return mask;
  mask = hn::And(mask, hn::And(above(1, 0), above(7, 0)));
  for (const int row : {0, 1, 2, 3, 5, 6, 7, 8})
    mask = hn::And(mask, hn::And(above(row, -1), above(row, 1)));
  for (const int row : {0, 2, 6, 8}) mask = hn::And(mask, above(row, 0));
  return mask;
}

int FindMaxima(const float* const* HWY_RESTRICT rows, int count, float threshold,
               int* HWY_RESTRICT columns) {
  const hn::ScalableTag<float> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int found = 0, x = 1;
  for (; x + lanes + 1 <= count; x += lanes) {
    const auto mask = MaximumMask(d, rows, x, hn::Set(d, threshold));
    if (HWY_LIKELY(hn::AllFalse(d, mask))) continue;
    std::uint8_t bits[32] = {};
    hn::StoreMaskBits(d, mask, bits);
    for (int i = 0; i < lanes; ++i)
      if (bits[i / 8] & (1 << (i % 8))) columns[found++] = x + i;
  }
  const hn::CappedTag<float, 1> one;
  for (; x + 1 < count; ++x)
    if (!hn::AllFalse(one, MaximumMask(one, rows, x, hn::Set(one, threshold))))
      columns[found++] = x;
  return found;
}

// Sums over boxes at the nodes of the turned grid, row by row without gaps.
constexpr int kNodes = kPatchNodes * kPatchNodes;
constexpr int kNodesPadded = (kNodes + 15) / 16 * 16;

struct NodeTable {
  alignas(64) float u[kNodesPadded], v[kNodesPadded];
};
const NodeTable& Nodes() {
  static const NodeTable table = [] {
    NodeTable made{};
    for (int k = 0; k < kNodes; ++k) {
      made.u[k] = static_cast<float>(k % kPatchNodes - 12);
      made.v[k] = static_cast<float>(k / kPatchNodes - 12);
    }
    return made;
  }();
  return table;
}

// Where the boxes of all nodes begin in an array of the given stride.
HWY_INLINE void NodeIndices(const SumsView& view, const PatchFrame& frame,
                            std::ptrdiff_t row_stride, std::int32_t* HWY_RESTRICT index) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  const NodeTable& nodes = Nodes();
  const float shift = static_cast<float>(frame.side - 1) / 2;
  const auto cosine = hn::Set(d, frame.cosine), sine = hn::Set(d, frame.sine);
  const auto x0 = hn::Set(d, frame.x - shift), y0 = hn::Set(d, frame.y - shift);
  const auto right = hn::Set(di, view.width - frame.side);
  const auto bottom = hn::Set(di, view.height - frame.side);
  const auto zero = hn::Zero(di), stride = hn::Set(di, static_cast<std::int32_t>(row_stride));
  for (int k = 0; k < kNodesPadded; k += static_cast<int>(hn::Lanes(d))) {
    const auto u = hn::Load(d, nodes.u + k), v = hn::Load(d, nodes.v + k);
    const auto x = hn::Add(x0, hn::Sub(hn::Mul(u, cosine), hn::Mul(v, sine)));
    const auto y = hn::Add(y0, hn::Add(hn::Mul(u, sine), hn::Mul(v, cosine)));
    const auto xi = hn::Min(hn::Max(hn::NearestInt(x), zero), right);
    const auto yi = hn::Min(hn::Max(hn::NearestInt(y), zero), bottom);
    hn::Store(hn::Add(hn::Mul(yi, stride), xi), di, index + k);
  }
}

// Plain loads: a gather of eight takes 50 cycles on Zen 3, the eight loads 4 to 8.
HWY_INLINE void SamplePatch(const SumsView& view, const BoxesView& boxes, const PatchFrame& frame,
                            float* HWY_RESTRICT patch) {
  alignas(64) std::int32_t index[kNodesPadded], sums[kNodesPadded];
  NodeIndices(view, frame, boxes.boxes ? boxes.stride : view.stride, index);
  if (boxes.boxes) {
#pragma GCC unroll 8
    for (int k = 0; k < kNodesPadded; ++k) sums[k] = boxes.boxes[index[k]];
  } else {
    const std::uint32_t* upper = view.sums;
    const std::uint32_t* lower = upper + frame.side * view.stride;
    for (int k = 0; k < kNodesPadded; ++k) {
      const std::int32_t left = index[k], right = left + frame.side;
      sums[k] = static_cast<std::int32_t>(lower[right] - lower[left] - upper[right] + upper[left]);
    }
  }
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  for (int k = 0; k < kNodesPadded; k += static_cast<int>(hn::Lanes(d)))
    hn::Store(hn::ConvertTo(d, hn::Load(di, sums + k)), d, patch + k);
}

void BoxRow(const SumsView& view, int y, int side, int count, std::uint16_t* HWY_RESTRICT out) {
  const hn::ScalableTag<std::int32_t> d;
  const hn::Rebind<std::uint16_t, decltype(d)> d16;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto* upper = reinterpret_cast<const std::int32_t*>(view.sums) + y * view.stride;
  const std::int32_t* lower = upper + side * view.stride;
  int x = 0;
  for (; x + lanes <= count; x += lanes) {
    const auto right = hn::Sub(hn::LoadU(d, lower + x + side), hn::LoadU(d, upper + x + side));
    const auto left = hn::Sub(hn::LoadU(d, lower + x), hn::LoadU(d, upper + x));
    hn::StoreU(hn::DemoteTo(d16, hn::Sub(right, left)), d16, out + x);
  }
  for (; x < count; ++x)
    out[x] = static_cast<std::uint16_t>(lower[x + side] - upper[x + side] - lower[x] + upper[x]);
}

// Column i of the 24 adds to the square `column` with the weight bins[column][i].
struct BinTable {
  alignas(64) float weight[4][24];
};
const BinTable& Bins() {
  static const BinTable table = [] {
    BinTable made{};
    for (int column = 0; column < 4; ++column)
      for (int tap = 0; tap < 9; ++tap)
        made.weight[column][5 * column + tap] = descriptor_weights().taps[tap];
    return made;
  }();
  return table;
}

void Descriptor(const SumsView& view, const BoxesView& boxes, const PatchFrame& frame,
                float* HWY_RESTRICT out) {
  alignas(64) float patch[kNodesPadded];
  SamplePatch(view, boxes, frame, patch);
  const hn::CappedTag<float, 8> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const DescriptorWeights& weights = descriptor_weights();
  const BinTable& bins = Bins();
  for (int row = 0; row < 4; ++row) {
    alignas(64) float sums[4][24];
    for (int i = 0; i < 24; i += lanes) {
      const float* at = patch + 5 * row * kPatchNodes + i;
      auto left = hn::LoadU(d, at), right = hn::LoadU(d, at + 1);
      auto dx_sum = hn::Zero(d), dy_sum = dx_sum, dx_abs = dx_sum, dy_abs = dx_sum;
      for (int tap = 0; tap < 9; ++tap) {
        at += kPatchNodes;
        const auto below_left = hn::LoadU(d, at), below_right = hn::LoadU(d, at + 1);
        const auto falling = hn::Sub(below_right, left), rising = hn::Sub(right, below_left);
        const auto weight = hn::Set(d, weights.taps[tap]);
        const auto dx = hn::Mul(hn::Add(falling, rising), weight);
        const auto dy = hn::Mul(hn::Sub(falling, rising), weight);
        dx_sum = hn::Add(dx_sum, dx);
        dy_sum = hn::Add(dy_sum, dy);
        dx_abs = hn::Add(dx_abs, hn::Abs(dx));
        dy_abs = hn::Add(dy_abs, hn::Abs(dy));
        left = below_left;
        right = below_right;
      }
      hn::Store(dx_sum, d, sums[0] + i);
      hn::Store(dy_sum, d, sums[1] + i);
      hn::Store(dx_abs, d, sums[2] + i);
      hn::Store(dy_abs, d, sums[3] + i);
    }
    for (int column = 0; column < 4; ++column) {
      const float square = weights.squares[row] * weights.squares[column];
      for (int k = 0; k < 4; ++k) {
        auto total = hn::Zero(d);
        for (int i = 0; i < 24; i += lanes)
          total = hn::Add(total,
                          hn::Mul(hn::Load(d, sums[k] + i), hn::Load(d, bins.weight[column] + i)));
        out[(row * 4 + column) * 4 + k] = hn::GetLane(hn::SumOfLanes(d, total)) * square;
      }
    }
  }
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

void SectorSums(const WaveletGrid& grid, const WaveletRange& range, float* HWY_RESTRICT out_x,
                float* HWY_RESTRICT out_y) {
  const hn::CappedTag<float, 8> d;
  const hn::RebindToSigned<decltype(d)> di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const WaveletWeights& weights = wavelet_weights();
  // Room for what runs over the end when sums of neighbours are taken.
  alignas(64) float x[kAngleBins + 24] = {}, y[kAngleBins + 24] = {};
  for (int j = range.first_row; j <= range.last_row; ++j) {
    alignas(64) float dx[16], dy[16];
    alignas(64) std::int32_t bin[16];
    for (int i = 0; i < 16; i += lanes) {
      const auto at = [&](int row, int column)
                          HWY_ATTR { return hn::LoadU(di, grid.sums[j + row] + i + column); };
      const auto left = hn::Sub(at(4, 0), at(0, 0)), right = hn::Sub(at(4, 4), at(0, 4));
      const auto centre = hn::Sub(at(4, 2), at(0, 2));
      const auto top = hn::Sub(at(0, 4), at(0, 0)), bottom = hn::Sub(at(4, 4), at(4, 0));
      const auto middle = hn::Sub(at(2, 4), at(2, 0));
      const auto weight = hn::LoadU(d, weights.at[j] + i);
      const auto twice = [&](hn::Vec<decltype(di)> v) HWY_ATTR { return hn::Add(v, v); };
      const auto vx =
          hn::Mul(hn::ConvertTo(d, hn::Sub(hn::Add(left, right), twice(centre))), weight);
      const auto vy =
          hn::Mul(hn::ConvertTo(d, hn::Sub(hn::Add(top, bottom), twice(middle))), weight);
      hn::Store(vx, d, dx + i);
      hn::Store(vy, d, dy + i);
      hn::Store(AngleBin(d, vx, vy), di, bin + i);
    }
    const int reach = weights.reach[j];
    const int last = std::min(range.last_column, kWaveletSide / 2 + reach);
    for (int i = std::max(range.first_column, kWaveletSide / 2 - reach); i <= last; ++i) {
      x[bin[i]] += dx[i];
      y[bin[i]] += dy[i];
    }
  }
  for (float* sums : {x, y}) {
    std::copy_n(sums, kSectorBins, sums + kAngleBins);
    alignas(64) float two[kAngleBins + 24], four[kAngleBins + 24];
    const auto join = [&](const float* a, const float* b, float* to, int count) HWY_ATTR {
      for (int i = 0; i < count; i += lanes)
        hn::StoreU(hn::Add(hn::LoadU(d, a + i), hn::LoadU(d, b + i)), d, to + i);
    };
    join(sums, sums + 1, two, kAngleBins + 16);
    join(two, two + 2, four, kAngleBins + 8);
    join(four, four + 4, two, kAngleBins);                       // eight
    join(two, four + 8, sums == x ? out_x : out_y, kAngleBins);  // twelve
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace posevote::simd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace posevote::simd {

HWY_EXPORT(SmoothRow);
HWY_EXPORT(IntegralRow);
HWY_EXPORT(HessianRow);
HWY_EXPORT(FindMaxima);
HWY_EXPORT(Descriptor);
HWY_EXPORT(SectorSums);
HWY_EXPORT(BoxRow);

void smooth_row(const std::uint8_t* const rows[5], int count, std::uint16_t* scratch,
                std::uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(SmoothRow)(rows, count, scratch, out);
}

void integral_row(const std::uint8_t* pixels, const std::uint32_t* above, int count,
                  std::uint32_t* out) {
  HWY_DYNAMIC_DISPATCH(IntegralRow)(pixels, above, count, out);
}

void hessian_row(const SumsView& view, int x, int y, int count, int lobe, float norm, float* out) {
  HWY_DYNAMIC_DISPATCH(HessianRow)(view, x, y, count, lobe, norm, out);
}

int find_maxima(const float* const rows[kMaximaRows], int count, float threshold, int* columns) {
  return HWY_DYNAMIC_DISPATCH(FindMaxima)(rows, count, threshold, columns);
}

void descriptor(const SumsView& view, const BoxesView& boxes, const PatchFrame& frame, float* out) {
  HWY_DYNAMIC_DISPATCH(Descriptor)(view, boxes, frame, out);
}

void box_row(const SumsView& view, int y, int side, int count, std::uint16_t* out) {
  HWY_DYNAMIC_DISPATCH(BoxRow)(view, y, side, count, out);
}

void sector_sums(const WaveletGrid& grid, const WaveletRange& range, float* x, float* y) {
  HWY_DYNAMIC_DISPATCH(SectorSums)(grid, range, x, y);
}

}  // namespace posevote::simd
#endif  // HWY_ONCE
