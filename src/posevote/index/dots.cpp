#include "posevote/index/dots.hpp"

// AVX-512 with VNNI is one of the targets. SVE is not: its vectors cannot stand in arrays.
#define HWY_WANT_AVX3_DL 1
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "posevote/index/dots.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include <cmath>
#include <cstring>

#include "posevote/index/sums.hpp"

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

using scalar::distances;
using scalar::dots;
using scalar::encode;
using scalar::find_at_least;
using scalar::kth_largest;
using scalar::scan;

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

/// GCC would load all queries of a round first, for which there are not enough registers: it spills
/// a sum in the innermost loop, which then takes twice as long. This keeps the order as written.
HWY_INLINE void keep_in_register([[maybe_unused]] Word& sum) {
#if HWY_ARCH_X86 && (HWY_COMPILER_GCC || HWY_COMPILER_CLANG)
  asm volatile("" : "+x"(sum.raw));
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
#pragma GCC unroll 4
    for (std::size_t q = 0; q < Q; ++q) {  // one after the other: see keep_in_register
      const Dword query = broadcast(queries[q] + quad * 4);
#pragma GCC unroll 4
      for (std::size_t v = 0; v < kVectors; ++v) {
        sums[q][v] = add_products(sums[q][v], codes[v], query);
        keep_in_register(sums[q][v]);
      }
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
constexpr Lanes kLanes;
constexpr std::size_t kStep = hn::MaxLanes(kLanes);

/// Bit i: is value i of kBlockLanes at least the limit?
HWY_INLINE std::uint32_t bits_at_least(const std::int16_t* values, hn::Vec<Lanes> limits) {
  std::uint32_t less = 0;
  for (std::size_t i = 0; i < kBlockLanes; i += kStep) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(kLanes, hn::Lt(hn::LoadU(kLanes, values + i), limits), bytes);
    less |= (bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8) << i;
  }
  return ~less & 0xFFFFU;
}

std::size_t find_at_least(const std::int16_t* values, std::size_t count, std::int16_t limit,
                          std::uint32_t* positions) {
  const auto limits = hn::Set(kLanes, limit);
  constexpr std::size_t kBits = 64;  // one loop over many bits: its end is guessed wrong less often
  std::size_t found = 0;
  for (std::size_t first = 0; first < count; first += kBits) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < HWY_MIN(kBits, count - first); i += kBlockLanes)
      bits |= static_cast<std::uint64_t>(bits_at_least(values + first + i, limits)) << i;
    for (; bits != 0; bits &= bits - 1)
      positions[found++] =
          static_cast<std::uint32_t>(first + hwy::Num0BitsBelowLS1Bit_Nonzero64(bits));
  }
  return found;
}

/// How many of `count` values, at most 32767 * kStep, are at least the limit.
HWY_INLINE std::size_t count_at_least(const std::int16_t* values, std::size_t count, int limit) {
  const auto limits = hn::Set(kLanes, static_cast<std::int16_t>(limit));
  auto less = hn::Zero(kLanes);
  for (std::size_t i = 0; i < count; i += kBlockLanes)
    for (std::size_t j = 0; j < kBlockLanes; j += kStep) {
      const auto some = hn::LoadU(kLanes, values + i + j);
      less = hn::Sub(less, hn::VecFromMask(kLanes, hn::Lt(some, limits)));
    }
  return count - static_cast<std::size_t>(hn::GetLane(hn::SumOfLanes(kLanes, less)));
}

/// Between `low`, which `enough` values reach, and `high`, which `few` reach: about where k do, as
/// numbers of values fall exponentially near their largest.
HWY_INLINE int guess_kth(int low, int high, std::size_t enough, std::size_t few, std::size_t k) {
  const float all =
      std::log2((static_cast<float>(enough) + 0.5F) / (static_cast<float>(few) + 0.5F));
  const float part = std::log2((static_cast<float>(enough) + 0.5F) / static_cast<float>(k));
  const int guess = low + static_cast<int>(static_cast<float>(high - low) * part / all);
  return HWY_MIN(HWY_MAX(guess, low + 1), high - 1);
}

/// By counting values above guesses: exact, and with few branches that depend on the values.
std::int16_t kth_largest(const std::int16_t* values, std::size_t count, std::size_t k) {
  if (count > 32767) return scalar::kth_largest(values, count, k);
  auto smallest = hn::LoadU(kLanes, values), largest = smallest;
  for (std::size_t i = 0; i < count; i += kStep) {
    const auto some = hn::LoadU(kLanes, values + i);
    smallest = hn::Min(smallest, some);
    largest = hn::Max(largest, some);
  }
  // At least k values are >= low, fewer are >= high.
  int low = hn::GetLane(hn::MinOfLanes(kLanes, smallest));
  int high = hn::GetLane(hn::MaxOfLanes(kLanes, largest)) + 1;
  std::size_t enough = count, few = 0;
  for (bool halve = false; high - low > 1 && enough > k; halve = !halve) {
    const int middle = halve ? (low + high) / 2 : guess_kth(low, high, enough, few, k);
    const std::size_t reach = count_at_least(values, count, middle);
    (reach >= k ? low : high) = middle;
    (reach >= k ? enough : few) = reach;
  }
  // The smallest of those that are at least `low`.
  const auto limits = hn::Set(kLanes, static_cast<std::int16_t>(low));
  auto kth = hn::Set(kLanes, std::int16_t{32767});
  for (std::size_t i = 0; i < count; i += kStep) {
    const auto some = hn::LoadU(kLanes, values + i);
    kth = hn::Min(kth, hn::IfThenElse(hn::Lt(some, limits), kth, some));
  }
  return hn::GetLane(hn::MinOfLanes(kLanes, kth));
}

template <std::size_t Q>
std::uint32_t scan_with(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
                        const ScanQuery* queries) {
  const std::int8_t* codes[Q];
  std::int32_t corrections[Q];
  for (std::size_t q = 0; q < Q; ++q) {
    codes[q] = queries[q].code;
    corrections[q] = queries[q].offset;
  }
  std::uint32_t some[Q] = {};
  for (std::size_t b = 0; b < block_count; ++b) {
    HWY_ALIGN std::int16_t products[Q * kBlockLanes];
    dots_of_block<Q>(blocks + b * quads * kRow, quads, codes, corrections, products, kBlockLanes);
    for (std::size_t q = 0; q < Q; ++q) {
      const std::int16_t* own = products + q * kBlockLanes;
      const std::uint32_t bits = bits_at_least(own, hn::Set(kLanes, queries[q].limit));
      queries[q].found[b] = static_cast<std::uint16_t>(bits);
      some[q] |= bits;
      if (bits != 0)
        std::memcpy(queries[q].products + b * kBlockLanes, own, kBlockLanes * sizeof *own);
    }
  }
  std::uint32_t result = 0;
  for (std::size_t q = 0; q < Q; ++q) result |= (some[q] != 0 ? 1U : 0U) << q;
  return result;
}

std::uint32_t scan(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
                   const ScanQuery* queries, std::size_t query_count) {
  std::uint32_t some = 0;
  for (std::size_t q = 0; q < query_count; q += kAtOnce) {
    const std::size_t count = HWY_MIN(query_count - q, kAtOnce);
    if (count == 1) some |= scan_with<1>(blocks, block_count, quads, queries + q) << q;
    if (count == 2) some |= scan_with<2>(blocks, block_count, quads, queries + q) << q;
    if (count == 3) some |= scan_with<3>(blocks, block_count, quads, queries + q) << q;
    if (count == 4) some |= scan_with<4>(blocks, block_count, quads, queries + q) << q;
  }
  return some;
}

/// Parts as in `sum_over`, so that the rounding is the same.
void distances(const float* query, const float* const* rows, std::size_t count,
               std::size_t dimension, float* results) {
  using Floats = hn::CappedTag<float, kSumParts>;
  constexpr Floats floats;
  constexpr std::size_t kWidth = hn::MaxLanes(floats);
  constexpr std::size_t kSums = kSumParts / kWidth;
  for (std::size_t i = 0; i < count; ++i) {
    const float* row = rows[i];
    hn::Vec<Floats> sums[kSums];
    for (std::size_t s = 0; s < kSums; ++s) sums[s] = hn::Zero(floats);
    std::size_t d = 0;
    for (; d + kSumParts <= dimension; d += kSumParts)
      for (std::size_t s = 0; s < kSums; ++s) {
        const auto difference = hn::Sub(hn::LoadU(floats, query + d + s * kWidth),
                                        hn::LoadU(floats, row + d + s * kWidth));
        sums[s] = hn::Add(sums[s], hn::Mul(difference, difference));
      }
    for (std::size_t n = kSums / 2; n > 0; n /= 2)
      for (std::size_t s = 0; s < n; ++s) sums[s] = hn::Add(sums[s], sums[s + n]);
    float parts[kWidth];
    hn::StoreU(sums[0], floats, parts);
    float sum = 0;
    for (; d < dimension; ++d) sum += (query[d] - row[d]) * (query[d] - row[d]);
    results[i] = std::sqrt(sum + sum_in_halves(parts));
  }
}

/// Parts as in `sum_over`.
Rounding encode(const float* row, std::size_t dimension, float scale, std::int8_t* code) {
  using Floats = hn::CappedTag<float, kSumParts>;
  constexpr Floats floats;
  constexpr hn::Rebind<std::int32_t, Floats> ints;
  constexpr hn::Rebind<std::int16_t, Floats> shorts;
  constexpr hn::Rebind<std::int8_t, Floats> bytes;
  constexpr std::size_t kWidth = hn::MaxLanes(floats);
  constexpr std::size_t kSums = kSumParts / kWidth;
  const float step = 1 / scale;
  hn::Vec<Floats> squares[kSums], lost[kSums];
  auto sum = hn::Zero(ints);
  for (std::size_t s = 0; s < kSums; ++s) squares[s] = lost[s] = hn::Zero(floats);
  std::size_t d = 0;
  for (; d + kSumParts <= dimension; d += kSumParts)
    for (std::size_t s = 0; s < kSums; ++s) {
      const auto value = hn::LoadU(floats, row + d + s * kWidth);
      const auto scaled = hn::Add(hn::Mul(value, hn::Set(floats, scale)), hn::Set(floats, 128.5F));
      const auto cut = hn::Min(hn::Max(scaled, hn::Set(floats, 1.0F)), hn::Set(floats, 255.0F));
      const auto whole = hn::Sub(hn::ConvertTo(ints, cut), hn::Set(ints, 128));
      hn::StoreU(hn::DemoteTo(bytes, hn::DemoteTo(shorts, whole)), bytes, code + d + s * kWidth);
      const auto error =
          hn::Sub(value, hn::Mul(hn::ConvertTo(floats, whole), hn::Set(floats, step)));
      squares[s] = hn::Add(squares[s], hn::Mul(error, error));
      lost[s] = hn::Add(lost[s], hn::Mul(error, value));
      sum = hn::Add(sum, whole);
    }
  float square_parts[kSumParts], lost_parts[kSumParts];
  for (std::size_t s = 0; s < kSums; ++s) {
    hn::StoreU(squares[s], floats, square_parts + s * kWidth);
    hn::StoreU(lost[s], floats, lost_parts + s * kWidth);
  }
  Rounding result;
  result.sum = hn::GetLane(hn::SumOfLanes(ints, sum));
  for (; d < dimension; ++d) {
    code[d] = round_to_code(row[d] * scale);
    const float error = row[d] - static_cast<float>(code[d]) * step;
    result.squares += error * error;
    result.lost += error * row[d];
    result.sum += code[d];
  }
  result.squares += sum_in_halves(square_parts);
  result.lost += sum_in_halves(lost_parts);
  return result;
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
HWY_EXPORT(distances);
HWY_EXPORT(dots);
HWY_EXPORT(encode);
HWY_EXPORT(find_at_least);
HWY_EXPORT(kth_largest);
HWY_EXPORT(scan);
}  // namespace

void dots(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
          const QueryGroup& queries, std::int16_t* products, std::size_t stride) {
  HWY_DYNAMIC_DISPATCH(dots)(blocks, block_count, quads, queries, products, stride);
}

std::size_t find_at_least(const std::int16_t* values, std::size_t count, std::int16_t limit,
                          std::uint32_t* positions) {
  return HWY_DYNAMIC_DISPATCH(find_at_least)(values, count, limit, positions);
}

std::int16_t kth_largest(const std::int16_t* values, std::size_t count, std::size_t k) {
  return HWY_DYNAMIC_DISPATCH(kth_largest)(values, count, k);
}

std::uint32_t scan(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
                   const ScanQuery* queries, std::size_t query_count) {
  return HWY_DYNAMIC_DISPATCH(scan)(blocks, block_count, quads, queries, query_count);
}

void distances(const float* query, const float* const* rows, std::size_t count,
               std::size_t dimension, float* results) {
  HWY_DYNAMIC_DISPATCH(distances)(query, rows, count, dimension, results);
}

Rounding encode(const float* row, std::size_t dimension, float scale, std::int8_t* code) {
  return HWY_DYNAMIC_DISPATCH(encode)(row, dimension, scale, code);
}

}  // namespace posevote
#endif
