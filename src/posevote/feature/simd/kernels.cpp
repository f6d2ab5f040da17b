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

// One vector of determinants; `at` points at the sum above and left of the first filter's centre.
template <class D>
HWY_INLINE hn::Vec<hn::RebindToFloat<D>> Determinants(D d, const std::int32_t* HWY_RESTRICT at,
                                                      std::ptrdiff_t stride, int lobe,
                                                      hn::Vec<hn::RebindToFloat<D>> norm) {
  const hn::RebindToFloat<D> df;
  const int middle = lobe / 2, half = lobe + middle, wide = lobe - 1;
  const auto corner = [&](int y, int x) HWY_ATTR { return hn::LoadU(d, at + y * stride + x); };
  const auto box = [&](int x0, int y0, int x1, int y1) HWY_ATTR {
    return hn::Add(hn::Sub(corner(y1, x1), corner(y1, x0)),
                   hn::Sub(corner(y0, x0), corner(y0, x1)));
  };
  const auto three = [&](hn::Vec<D> v) HWY_ATTR { return hn::Add(v, hn::Add(v, v)); };
  const auto xx = hn::Sub(box(-half, -wide, half + 1, wide + 1),
                          three(box(-middle, -wide, middle + 1, wide + 1)));
  const auto yy = hn::Sub(box(-wide, -half, wide + 1, half + 1),
                          three(box(-wide, -middle, wide + 1, middle + 1)));
  const auto same = hn::Add(box(-lobe, -lobe, 0, 0), box(1, 1, lobe + 1, lobe + 1));
  const auto other = hn::Add(box(1, -lobe, lobe + 1, 0), box(-lobe, 1, 0, lobe + 1));
  const auto fxx = hn::Mul(hn::ConvertTo(df, xx), norm);
  const auto fyy = hn::Mul(hn::ConvertTo(df, yy), norm);
  const auto fxy = hn::Mul(hn::ConvertTo(df, hn::Sub(same, other)), norm);
  return hn::Sub(hn::Mul(fxx, fyy), hn::Mul(hn::Mul(fxy, fxy), hn::Set(df, 0.81F)));
}

void HessianRow(const SumsView& view, int x, int y, int count, int lobe, float norm,
                float* HWY_RESTRICT out) {
  const hn::ScalableTag<std::int32_t> d;
  const hn::RebindToFloat<decltype(d)> df;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto* at = reinterpret_cast<const std::int32_t*>(view.sums) + y * view.stride + x;
  int i = 0;
  for (; i + lanes <= count; i += lanes)
    hn::StoreU(Determinants(d, at + i, view.stride, lobe, hn::Set(df, norm)), df, out + i);
  const hn::CappedTag<std::int32_t, 1> one;
  const hn::RebindToFloat<decltype(one)> one_f;
  for (; i < count; ++i)
    hn::StoreU(Determinants(one, at + i, view.stride, lobe, hn::Set(one_f, norm)), one_f, out + i);
}

template <class D>
HWY_INLINE hn::Mask<D> MaximumMask(D d, const float* const* rows, int x, hn::Vec<D> threshold) {
  const auto centre = hn::LoadU(d, rows[4] + x);
  auto mask = hn::Ge(centre, threshold);
  if (HWY_LIKELY(hn::AllFalse(d, mask))) return mask;
  const auto above = [&](int row, int shift)
                         HWY_ATTR { return hn::Gt(centre, hn::LoadU(d, rows[row] + x + shift)); };
  mask = hn::And(mask, hn::And(above(4, -1), above(4, 1)));
  mask = hn::And(mask, hn::And(above(3, 0), above(5, 0)));
  if (hn::AllFalse(d, mask)) return mask;
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

HWY_INLINE void SamplePatch(const SumsView& view, const PatchFrame& frame,
                            float* HWY_RESTRICT patch) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  const NodeTable& nodes = Nodes();
  const float shift = static_cast<float>(frame.side - 1) / 2;
  const auto cosine = hn::Set(d, frame.cosine), sine = hn::Set(d, frame.sine);
  const auto x0 = hn::Set(d, frame.x - shift), y0 = hn::Set(d, frame.y - shift);
  const auto right = hn::Set(di, view.width - frame.side);
  const auto bottom = hn::Set(di, view.height - frame.side);
  const auto zero = hn::Zero(di), stride = hn::Set(di, static_cast<std::int32_t>(view.stride));
  const auto* sums = reinterpret_cast<const std::int32_t*>(view.sums);
  const std::int32_t* lower = sums + frame.side * view.stride;
  for (int k = 0; k < kNodesPadded; k += static_cast<int>(hn::Lanes(d))) {
    const auto u = hn::Load(d, nodes.u + k), v = hn::Load(d, nodes.v + k);
    const auto x = hn::Add(x0, hn::Sub(hn::Mul(u, cosine), hn::Mul(v, sine)));
    const auto y = hn::Add(y0, hn::Add(hn::Mul(u, sine), hn::Mul(v, cosine)));
    const auto xi = hn::Min(hn::Max(hn::NearestInt(x), zero), right);
    const auto yi = hn::Min(hn::Max(hn::NearestInt(y), zero), bottom);
    const auto at = hn::Add(hn::Mul(yi, stride), xi);
    const auto upper_sum =
        hn::Sub(hn::GatherIndex(di, sums, at), hn::GatherIndex(di, sums + frame.side, at));
    const auto lower_sum =
        hn::Sub(hn::GatherIndex(di, lower + frame.side, at), hn::GatherIndex(di, lower, at));
    hn::Store(hn::ConvertTo(d, hn::Add(upper_sum, lower_sum)), d, patch + k);
  }
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

void Descriptor(const SumsView& view, const PatchFrame& frame, float* HWY_RESTRICT out) {
  alignas(64) float patch[kNodesPadded];
  SamplePatch(view, frame, patch);
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

void descriptor(const SumsView& view, const PatchFrame& frame, float* out) {
  HWY_DYNAMIC_DISPATCH(Descriptor)(view, frame, out);
}

}  // namespace posevote::simd
#endif  // HWY_ONCE
