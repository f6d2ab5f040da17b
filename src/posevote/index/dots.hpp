// Kernels of the scan: scalar products of 8-bit codes, many taught descriptors at once.
#pragma once

#include <cstddef>
#include <cstdint>

namespace posevote {

/// Taught codes lie in blocks of this many, quad of dimensions by quad: byte
/// [block][quad][lane][4]; a block takes quads * kBlockLanes * 4 bytes.
inline constexpr std::size_t kBlockLanes = 16;

/// Most queries of one call of `dots`.
inline constexpr std::size_t kMaxQueries = 4;

/// A group of queries for one pass over the blocks.
struct QueryGroup {
  const std::int8_t* codes[kMaxQueries];  ///< `quads` * 4 bytes each
  std::size_t count;                      ///< 1 ... kMaxQueries
};

/// products[q][i] = sum over d of (code_d(i) - 128) * query_d(q), modulo 2^16, for the
/// `block_count` * kBlockLanes codes at `blocks`; the rows of `products` lie `stride` apart.
/// Requires for each pair of query dimensions (2j, 2j + 1): |a| + |b| <= 128. Every instruction set
/// gives the same numbers.
void dots(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
          const QueryGroup& queries, std::int16_t* products, std::size_t stride);

/// A query of `scan` and where the answers go.
struct ScanQuery {
  const std::int8_t* code;  ///< `quads` * 4 bytes, with the condition of `dots`
  std::int32_t offset;      ///< 128 * sum of the code
  std::int16_t limit;       ///< smallest product that is wanted
  std::int16_t* products;   ///< room for the products of all codes, as `dots` writes them
  std::uint16_t* found;     ///< for each block: bit i tells whether product i is wanted
};

/// As `dots`, and says which products are large enough. Bit q of the result: query q has some;
/// without any its `products` are not written.
[[nodiscard]] std::uint32_t scan(const std::uint8_t* blocks, std::size_t block_count,
                                 std::size_t quads, const ScanQuery* queries,
                                 std::size_t query_count);

/// Writes the positions of all values >= limit in rising order to `positions` (room for `count`)
/// and returns their number. `count` is a multiple of kBlockLanes.
[[nodiscard]] std::size_t find_at_least(const std::int16_t* values, std::size_t count,
                                        std::int16_t limit, std::uint32_t* positions);

/// The k-th largest of `count` values. `count` is a multiple of kBlockLanes, 1 <= k <= count.
[[nodiscard]] std::int16_t kth_largest(const std::int16_t* values, std::size_t count,
                                       std::size_t k);

/// Euclidean distances of `query` and `count` rows of `dimension` floats. Every instruction set
/// gives the same numbers.
void distances(const float* query, const float* const* rows, std::size_t count,
               std::size_t dimension, float* results);

/// What the code of a row is made of, and what it loses.
struct Rounding {
  float squares = 0;     ///< of (row - what the code stands for)
  float lost = 0;        ///< product of (row - what the code stands for) and row
  std::int32_t sum = 0;  ///< of the code
};

/// code[d] = round(row[d] * scale), at least -127 and at most 127, for finite rows.
[[nodiscard]] Rounding encode(const float* row, std::size_t dimension, float scale,
                              std::int8_t* code);

/// The same in plain C++: what the kernels are compared with, and what a build without Highway
/// runs.
namespace scalar {
void dots(const std::uint8_t* blocks, std::size_t block_count, std::size_t quads,
          const QueryGroup& queries, std::int16_t* products, std::size_t stride);
[[nodiscard]] std::uint32_t scan(const std::uint8_t* blocks, std::size_t block_count,
                                 std::size_t quads, const ScanQuery* queries,
                                 std::size_t query_count);
[[nodiscard]] std::size_t find_at_least(const std::int16_t* values, std::size_t count,
                                        std::int16_t limit, std::uint32_t* positions);
[[nodiscard]] std::int16_t kth_largest(const std::int16_t* values, std::size_t count,
                                       std::size_t k);
void distances(const float* query, const float* const* rows, std::size_t count,
               std::size_t dimension, float* results);
[[nodiscard]] Rounding encode(const float* row, std::size_t dimension, float scale,
                              std::int8_t* code);
}  // namespace scalar

}  // namespace posevote
