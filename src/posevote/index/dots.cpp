#include "posevote/index/dots.hpp"

// AVX-512 with VNNI is one of the targets. SVE is not: its vectors cannot stand in arrays.
#define HWY_WANT_AVX3_DL 1
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "posevote/index/dots.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include <cstring>

HWY_BEFORE_NAMESPACE();
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3_DL
#define POSEVOTE_VNNI 1
// Highway 1.0 selects this target by VNNI, but does not switch the compiler to it.
HWY_PUSH_ATTRIBUTES(HWY_TARGET_STR ",avx512vnni")
#endif
namespace posevote {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

using scalar::block_maxima;
using scalar::dots;
using scalar::find_at_least;

#else

constexpr std::size_t kRow = kBlockLanes * 4;  ///< bytes of one quad of a block
using Bytes = hn::CappedTag<std::uint8_t, kRow>;
using Words = hn::Repartition<std::int16_t, Bytes>;
using Dwords = hn::Repartition<std::int32_t, Bytes>;
constexpr Bytes kBytes;
constexpr Words kWords;
constexpr Dwords kDwords;
using Word = hn::Vec<Words>;
using Dword = hn::Vec<Dwords>;
constexpr std::size_t kVectors = kRow / hn::MaxLanes(kBytes);
// As many accumulators as 16 registers hold beside the operands.
constexpr std::size_t kAtOnce = kVectors == 4 ? 2 : 4;

HWY_INLINE Dword broadcast(const std::int8_t* quad) {
  std::int32_t four;
  std::memcpy(&four, quad, 4);
  return hn::Set(kDwords, four);
}

#ifdef POSEVOTE_VNNI

/// One vector is a whole row: four products are added to each 32-bit lane in one instruction. Two
/// sets of accumulators hide its latency.
template <std::size_t Q>
HWY_INLINE void dots_of_block(const std::uint8_t* block, std::size_t quads,
                              const std::int8_t* const* queries, const std::int32_t* corrections,
                              std::int16_t* products, std::size_t stride) {
  __m512i even[Q], odd[Q];
  for (std::size_t q = 0; q < Q; ++q) {
    even[q] = _mm512_set1_epi32(-corrections[q]);
    odd[q] = _mm512_setzero_si512();
  }
  std::size_t quad = 0;
  for (; quad + 2 <= quads; quad += 2) {
    const __m512i a = _mm512_loadu_si512(block + quad * kRow);
    const __m512i b = _mm512_loadu_si512(block + (quad + 1) * kRow);
    for (std::size_t q = 0; q < Q; ++q) {
      even[q] = _mm512_dpbusd_epi32(even[q], a, broadcast(queries[q] + quad * 4).raw);
      odd[q] = _mm512_dpbusd_epi32(odd[q], b, broadcast(queries[q] + quad * 4 + 4).raw);
    }
  }
  if (quad < quads) {
    const __m512i a = _mm512_loadu_si512(block + quad * kRow);
    for (std::size_t q = 0; q < Q; ++q)
      even[q] = _mm512_dpbusd_epi32(even[q], a, broadcast(queries[q] + quad * 4).raw);
  }
  for (std::size_t q = 0; q < Q; ++q)
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(products + q * stride),
                        _mm512_cvtepi32_epi16(_mm512_add_epi32(even[q], odd[q])));
}

#else

/// sum + a0 * b0 + a1 * b1 for each pair of bytes, a without and b with sign, modulo 2^16.
HWY_INLINE Word add_products(Word sum, hn::Vec<Bytes> a, Dword b) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
  return hn::Add(sum, Word{_mm512_maddubs_epi16(a.raw, b.raw)});
#elif HWY_TARGET == HWY_AVX2
  return hn::Add(sum, Word{_mm256_maddubs_epi16(a.raw, b.raw)});
#elif HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_SSSE3
  return hn::Add(sum, Word{_mm_maddubs_epi16(a.raw, b.raw)});
#else
  const Word pairs_a = hn::BitCast(kWords, a);
  const Word pairs_b = hn::BitCast(kWords, b);
  const Word low_a = hn::And(pairs_a, hn::Set(kWords, 0xFF));
  const hn::RebindToUnsigned<Words> unsigned_words;
  const Word high_a = hn::BitCast(kWords, hn::ShiftRight<8>(hn::BitCast(unsigned_words, pairs_a)));
  const Word low_b = hn::ShiftRight<8>(hn::ShiftLeft<8>(pairs_b));
  const Word high_b = hn::ShiftRight<8>(pairs_b);
  return hn::Add(sum, hn::Add(hn::Mul(low_a, low_b), hn::Mul(high_a, high_b)));
#endif
}

/// Adds the two words of each lane, takes `correction` off and stores the kBlockLanes results.
HWY_INLINE void store_sums(const Word* sums, std::int32_t correction, std::int16_t* products) {
#if HWY_TARGET == HWY_AVX2
  const __m256i pairs = _mm256_hadd_epi16(sums[0].raw, sums[1].raw);
  const __m256i ordered = _mm256_permute4x64_epi64(pairs, _MM_SHUFFLE(3, 1, 2, 0));
  const __m256i offset = _mm256_set1_epi16(static_cast<std::int16_t>(correction));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(products), _mm256_sub_epi16(ordered, offset));
#else
  const hn::Rebind<std::int16_t, Dwords> half;
  for (std::size_t v = 0; v < kVectors; ++v) {
    const Dword pairs = hn::BitCast(kDwords, sums[v]);
    const Dword low = hn::ShiftRight<16>(hn::ShiftLeft<16>(pairs));
    const Dword sum =
        hn::Sub(hn::Add(low, hn::ShiftRight<16>(pairs)), hn::Set(kDwords, correction));
    const Dword wrapped = hn::ShiftRight<16>(hn::ShiftLeft<16>(sum));
    hn::StoreU(hn::DemoteTo(half, wrapped), half, products + v * hn::MaxLanes(half));
  }
#endif
}

template <std::size_t Q>
HWY_INLINE void dots_of_block(const std::uint8_t* block, std::size_t quads,
                              const std::int8_t* const* queries, const std::int32_t* corrections,
                              std::int16_t* products, std::size_t stride) {
  Word sums[Q][kVectors];
  for (std::size_t q = 0; q < Q; ++q)
    for (std::size_t v = 0; v < kVectors; ++v) sums[q][v] = hn::Zero(kWords);
  for (std::size_t quad = 0; quad < quads; ++quad) {
    hn::Vec<Bytes> codes[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v)
      codes[v] = hn::LoadU(kBytes, block + quad * kRow + v * hn::MaxLanes(kBytes));
    for (std::size_t q = 0; q < Q; ++q) {
      const Dword query = broadcast(queries[q] + quad * 4);
      for (std::size_t v = 0; v < kVectors; ++v)
        sums[q][v] = add_products(sums[q][v], codes[v], query);
    }
  }
  for (std::size_t q = 0; q < Q; ++q) store_sums(sums[q], corrections[q], products + q * stride);
}

#endif

template <std::size_t Q>
void dots_of_queries(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
                     const std::int8_t* const* queries, std::int16_t* products,
                     std::size_t stride) {
  std::int32_t corrections[Q] = {};  // the codes are offset by 128
  for (std::size_t q = 0; q < Q; ++q)
    for (std::size_t d = 0; d < quads * 4; ++d) corrections[q] += 128 * queries[q][d];
  for (std::size_t b = 0; b < block_count; ++b)
    dots_of_block<Q>(blocks + b * quads * kRow, quads, queries, corrections,
                     products + b * kBlockLanes, stride);
}

void dots(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
          const QueryGroup& queries, std::int16_t* products, std::size_t stride) {
  for (std::size_t q = 0; q < queries.count; q += kAtOnce) {
    const std::int8_t* const* codes = queries.codes + q;
    std::int16_t* rows = products + q * stride;
    const std::size_t count = HWY_MIN(queries.count - q, kAtOnce);
    if (count == 1) dots_of_queries<1>(blocks, block_count, quads, codes, rows, stride);
    if (count == 2) dots_of_queries<2>(blocks, block_count, quads, codes, rows, stride);
    if (count == 3) dots_of_queries<3>(blocks, block_count, quads, codes, rows, stride);
    if (count == 4) dots_of_queries<4>(blocks, block_count, quads, codes, rows, stride);
  }
}

using Lanes = hn::CappedTag<std::int16_t, kBlockLanes>;

std::size_t find_at_least(const std::int16_t* values, std::size_t count, std::int16_t limit,
                          std::uint32_t* positions) {
  constexpr Lanes lanes;
  constexpr std::size_t kStep = hn::MaxLanes(lanes);
  const auto limits = hn::Set(lanes, limit);
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; i += kStep) {
    if (hn::AllTrue(lanes, hn::Lt(hn::LoadU(lanes, values + i), limits))) continue;
    for (std::size_t j = i; j < i + kStep; ++j)
      if (values[j] >= limit) positions[found++] = static_cast<std::uint32_t>(j);
  }
  return found;
}

void block_maxima(const std::int16_t* values, std::size_t count, std::int16_t* maxima) {
  constexpr Lanes lanes;
  constexpr std::size_t kStep = hn::MaxLanes(lanes);
  for (std::size_t i = 0; i < count; i += kBlockLanes) {
    auto largest = hn::LoadU(lanes, values + i);
    for (std::size_t j = kStep; j < kBlockLanes; j += kStep)
      largest = hn::Max(largest, hn::LoadU(lanes, values + i + j));
    maxima[i / kBlockLanes] = hn::GetLane(hn::MaxOfLanes(lanes, largest));
  }
}

#endif  // HWY_SCALAR

}  // namespace HWY_NAMESPACE
}  // namespace posevote
#ifdef POSEVOTE_VNNI
#undef POSEVOTE_VNNI
HWY_POP_ATTRIBUTES
#endif
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace posevote {
namespace {
HWY_EXPORT(dots);
HWY_EXPORT(find_at_least);
HWY_EXPORT(block_maxima);
}  // namespace

void dots(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
          const QueryGroup& queries, std::int16_t* products, std::size_t stride) {
  HWY_DYNAMIC_DISPATCH(dots)(blocks, block_count, quads, queries, products, stride);
}

std::size_t find_at_least(const std::int16_t* values, std::size_t count, std::int16_t limit,
                          std::uint32_t* positions) {
  return HWY_DYNAMIC_DISPATCH(find_at_least)(values, count, limit, positions);
}

void block_maxima(const std::int16_t* values, std::size_t count, std::int16_t* maxima) {
  HWY_DYNAMIC_DISPATCH(block_maxima)(values, count, maxima);
}

}  // namespace posevote
#endif
