// Sums of floats in one order for every instruction set.
#pragma once

#include <cstddef>

namespace posevote {

/// Sums have this many independent parts, so that vectors can be used without reordering.
inline constexpr std::size_t kSumParts = 16;

/// Sum of term(d) for d < count: parts of every 16th term, from the first of the full rounds on;
/// then what is left over in order, then the parts in order.
template <class Term>
float sum_over(std::size_t count, const Term& term) {
  float parts[kSumParts] = {};
  std::size_t d = 0;
  for (; d + kSumParts <= count; d += kSumParts)
    for (std::size_t i = 0; i < kSumParts; ++i) parts[i] += term(d + i);
  float sum = 0;
  for (; d < count; ++d) sum += term(d);
  for (const float part : parts) sum += part;
  return sum;
}

}  // namespace posevote
