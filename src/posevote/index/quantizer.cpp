#include "posevote/index/quantizer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "posevote/index/parallel.hpp"

namespace posevote {
namespace {

constexpr int kIterations = 8;  // the mean similarity moves by less than 0.1 % afterwards

/// Mean direction of the rows of each list; a list without rows keeps its centre.
void move_centers(int dimension, const std::vector<std::uint16_t>& lists,
                  const Centers::ReadRow& row, std::vector<float>& centers) {
  const auto size = static_cast<std::size_t>(dimension);
  std::vector<float> sums(centers.size());
  std::vector<float> buffer;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const float* values = row(i, buffer);
    float* sum = &sums[lists[i] * size];
    for (std::size_t d = 0; d < size; ++d) sum[d] += values[d];
  }
  for (std::size_t c = 0; c * size < centers.size(); ++c) {
    const float* sum = &sums[c * size];
    const float length = std::sqrt(std::inner_product(sum, sum + size, sum, 0.0F));
    if (!(length > 0)) continue;
    for (std::size_t d = 0; d < size; ++d) centers[c * size + d] = sum[d] / length;
  }
}

/// A scale at which the codes of nearly all rows, less their centres, are neither cut nor
/// shortened.
float find_member_scale(const Coder& coder, const Centers& centers,
                        const std::vector<std::uint16_t>& lists, const Centers::ReadRow& row) {
  constexpr float kLongest = 140, kHighest = 127;  // rounding stays within the limits of Coder
  std::vector<float> scales;
  std::vector<float> buffer;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const float* values = row(i, buffer);
    const float* center = centers.center(lists[i]);
    float squares = 1e-6F, highest = 1e-3F;
    for (int d = 0; d < coder.dimension(); ++d) {
      const float v = values[d] - center[d];
      squares += v * v;
      highest = std::max(highest, std::abs(v));
    }
    scales.push_back(std::min(kLongest / std::sqrt(squares), kHighest / highest));
  }
  const auto nearly_all = scales.begin() + static_cast<std::ptrdiff_t>(scales.size() / 100);
  std::nth_element(scales.begin(), nearly_all, scales.end());
  return std::max(kUnitScale, *nearly_all);
}

}  // namespace

Centers::Centers(const Coder& coder, std::size_t count, std::vector<std::uint8_t> codes,
                 float member_scale)
    : count_(count), codes_(std::move(codes)), member_scale_(member_scale) {
  const auto size = static_cast<std::size_t>(coder.dimension());
  values_.resize(count * size);
  for (std::size_t i = 0; i < count; ++i)
    coder.decode_taught(&codes_[i / kBlockLanes * coder.block_bytes()], i % kBlockLanes, kUnitScale,
                        &values_[i * size]);
}

Centers Centers::train(const Coder& coder, std::size_t count, std::size_t sample_count,
                       const ReadRow& row, int threads) {
  const auto size = static_cast<std::size_t>(coder.dimension());
  std::vector<float> centers(count * size);
  std::vector<const float*> rows;
  std::vector<float> buffer;
  for (std::size_t c = 0; c < count; ++c) {
    const float* values = row(c * sample_count / count, buffer);
    std::copy(values, values + size, &centers[c * size]);
    rows.push_back(&centers[c * size]);
  }
  Centers result(coder, count, coder.encode_all(rows), kUnitScale);
  std::vector<std::uint16_t> lists(sample_count);
  for (int i = 0; i < kIterations; ++i) {
    result.assign(coder, sample_count, row, lists.data(), threads);
    move_centers(coder.dimension(), lists, row, centers);
    result = Centers(coder, count, coder.encode_all(rows), kUnitScale);
  }
  result.assign(coder, sample_count, row, lists.data(), threads);
  result.member_scale_ = find_member_scale(coder, result, lists, row);
  return result;
}

void Centers::assign(const Coder& coder, std::size_t row_count, const ReadRow& row,
                     std::uint16_t* lists, int threads) const {
  if (count_ <= 1) {
    std::fill(lists, lists + row_count, std::uint16_t{0});
    return;
  }
  const std::size_t groups = (row_count + kMaxQueries - 1) / kMaxQueries;
  parallel(threads, groups, [&](std::size_t begin, std::size_t end) {
    std::vector<float> values;
    Buffer buffer;
    std::vector<std::int8_t> codes(kMaxQueries * coder.quads() * 4);
    for (std::size_t first = begin * kMaxQueries; first < std::min(row_count, end * kMaxQueries);
         first += kMaxQueries) {
      QueryGroup group{};
      group.count = std::min(kMaxQueries, row_count - first);
      for (std::size_t q = 0; q < group.count; ++q) {
        group.codes[q] = &codes[q * coder.quads() * 4];
        coder.encode_query(row(first + q, values), &codes[q * coder.quads() * 4]);
      }
      Probe found[kMaxQueries];
      nearest(coder, group, 1, buffer, found);
      for (std::size_t q = 0; q < group.count; ++q) lists[first + q] = found[q].list;
    }
  });
}

void Centers::nearest(const Coder& coder, const QueryGroup& queries, std::size_t probes,
                      Buffer& buffer, Probe* found) const {
  probes = std::min(probes, this->lists());
  if (count_ <= 1) {
    std::fill(found, found + queries.count, Probe{0, 0});
    return;
  }
  auto& [products, positions] = buffer;
  products.resize(queries.count * padded());
  positions.resize(padded());
  dots(codes_.data(), padded() / kBlockLanes, coder.quads(), queries, products.data(), padded());
  for (std::size_t q = 0; q < queries.count; ++q, found += probes) {
    std::int16_t* values = &products[q * padded()];
    std::fill(values + count_, values + padded(), std::numeric_limits<std::int16_t>::min());
    const std::int16_t last = kth_largest(values, padded(), probes);
    const std::size_t enough = find_at_least(values, padded(), last, positions.data());
    std::size_t surplus = enough - probes;  // of the equally near ones at the end
    std::size_t next = probes;
    for (std::size_t i = enough; i-- > 0;) {
      const std::uint32_t position = positions[i];
      if (surplus > 0 && values[position] == last) {
        --surplus;
        continue;
      }
      found[--next] = {static_cast<std::uint16_t>(position), values[position]};
    }
    const auto best = std::max_element(found, found + probes, [](const Probe& a, const Probe& b) {
      return a.product < b.product;
    });
    std::rotate(found, best, best + 1);
  }
}

}  // namespace posevote
