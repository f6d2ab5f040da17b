#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "posevote/index/dots.hpp"
#include "posevote/index/sums.hpp"

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

std::int16_t kth_largest(const std::int16_t* values, std::size_t count, std::size_t k) {
  std::vector<std::int16_t> copy(values, values + count);
  const auto kth = copy.begin() + static_cast<std::ptrdiff_t>(k - 1);
  std::nth_element(copy.begin(), kth, copy.end(), std::greater<>());
  return *kth;
}

std::uint32_t scan(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
                   const ScanQuery* queries, std::size_t query_count) {
  std::uint32_t some = 0;
  for (const ScanQuery* query = queries; query != queries + query_count; ++query) {
    dots(blocks, block_count, quads, {{query->code}, 1}, query->products,
         block_count * kBlockLanes);
    std::fill(query->found, query->found + block_count, std::uint16_t{0});
    for (std::size_t i = 0; i < block_count * kBlockLanes; ++i)
      if (query->products[i] >= query->limit) {
        query->found[i / kBlockLanes] |= static_cast<std::uint16_t>(1U << i % kBlockLanes);
        some |= 1U << (query - queries);
      }
  }
  return some;
}

void distances(const float* query, const float* const* rows, std::size_t count,
               std::size_t dimension, float* results) {
  for (std::size_t i = 0; i < count; ++i) {
    const float* row = rows[i];
    results[i] = std::sqrt(sum_over(
        dimension, [=](std::size_t d) { return (query[d] - row[d]) * (query[d] - row[d]); }));
  }
}

Rounding encode(const float* row, std::size_t dimension, float scale, std::int8_t* code) {
  const float step = 1 / scale;
  const auto error = [=](std::size_t d) { return row[d] - static_cast<float>(code[d]) * step; };
  Rounding result;
  for (std::size_t d = 0; d < dimension; ++d) {
    code[d] = round_to_code(row[d] * scale);
    result.sum += code[d];
  }
  result.squares = sum_over(dimension, [=](std::size_t d) { return error(d) * error(d); });
  result.lost = sum_over(dimension, [=](std::size_t d) { return error(d) * row[d]; });
  return result;
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

std::uint32_t scan(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
                   const ScanQuery* queries, std::size_t query_count) {
  return scalar::scan(blocks, block_count, quads, queries, query_count);
}

std::int16_t kth_largest(const std::int16_t* values, std::size_t count, std::size_t k) {
  return scalar::kth_largest(values, count, k);
}

void distances(const float* query, const float* const* rows, std::size_t count,
               std::size_t dimension, float* results) {
  scalar::distances(query, rows, count, dimension, results);
}

Rounding encode(const float* row, std::size_t dimension, float scale, std::int8_t* code) {
  return scalar::encode(row, dimension, scale, code);
}
#endif

}  // namespace posevote
