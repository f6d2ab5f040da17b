#include <algorithm>

#include "posevote/index/dots.hpp"

namespace posevote {
namespace scalar {

void dots(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
          const QueryGroup& queries, std::int16_t* products, std::size_t stride) {
  for (std::size_t q = 0; q < queries.count; ++q)
    for (std::size_t i = 0; i < block_count * kBlockLanes; ++i) {
      const std::uint8_t* code =
          blocks + (i / kBlockLanes * quads * kBlockLanes + i % kBlockLanes) * 4;
      int sum = 0;
      for (std::size_t d = 0; d < quads * 4; ++d)
        sum += (code[d / 4 * kBlockLanes * 4 + d % 4] - 128) * queries.codes[q][d];
      products[q * stride + i] = static_cast<std::int16_t>(sum);
    }
}

std::size_t find_at_least(const std::int16_t* values, std::size_t count, std::int16_t limit,
                          std::uint32_t* positions) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (values[i] >= limit) positions[found++] = static_cast<std::uint32_t>(i);
  return found;
}

void block_maxima(const std::int16_t* values, std::size_t count, std::int16_t* maxima) {
  for (std::size_t i = 0; i < count; i += kBlockLanes)
    maxima[i / kBlockLanes] = *std::max_element(values + i, values + i + kBlockLanes);
}

}  // namespace scalar

#ifndef POSEVOTE_WITH_HIGHWAY
void dots(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
          const QueryGroup& queries, std::int16_t* products, std::size_t stride) {
  scalar::dots(blocks, block_count, quads, queries, products, stride);
}

std::size_t find_at_least(const std::int16_t* values, std::size_t count, std::int16_t limit,
                          std::uint32_t* positions) {
  return scalar::find_at_least(values, count, limit, positions);
}

void block_maxima(const std::int16_t* values, std::size_t count, std::int16_t* maxima) {
  scalar::block_maxima(values, count, maxima);
}
#endif

}  // namespace posevote
