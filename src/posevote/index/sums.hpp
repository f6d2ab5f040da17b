// Arithmetic that gives the same numbers with every instruction set.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace posevote {

/// Sums have this many independent parts, so that vectors can be used without reordering.
inline constexpr std::size_t kSumParts = 16;

/// Sum of numbers, a power of two of them: in halves, as vectors are added up. Overwrites them.
template <std::size_t kCount>
float sum_in_halves(float (&parts)[kCount]) {
  for (std::size_t half = kCount / 2; half > 0; half /= 2)
    for (std::size_t i = 0; i < half; ++i) parts[i] += parts[i + half];
  return parts[0];
}

/// Sum of term(d) for d < count: parts of every 16th term, from the first of the full rounds on;
/// then what is left over in order, then the parts in halves.
template <class Term>
float sum_over(std::size_t count, const Term& term) {
  float parts[kSumParts] = {};
  std::size_t d = 0;
  for (; d + kSumParts <= count; d += kSumParts)
    for (std::size_t i = 0; i < kSumParts; ++i) parts[i] += term(d + i);
  float sum = 0;
  for (; d < count; ++d) sum += term(d);
  return sum + sum_in_halves(parts);
}

/// round(v), in [-127, 127].
inline std::int8_t round_to_code(float v) {
  // Positive, so that cutting off rounds.
  return static_cast<std::int8_t>(static_cast<int>(std::clamp(v + 128.5F, 1.0F, 255.0F)) - 128);
}

}  // namespace posevote
