#include "posevote/index/codes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <opencv2/core/hal/hal.hpp>

#include "posevote/index/dots.hpp"

namespace posevote {
namespace {

// The scalar product of two codes, which is at most the product of their lengths, fits in 16 bits.
constexpr float kLargestProduct = 32767;
constexpr float kTaughtLength = 150;

/// By how much rounding can lengthen a code.
float rounding_length(int dimension) {
  return std::sqrt(static_cast<float>(dimension)) / 2;
}

/// round(v), in [-127, 127], plus 128.
int offset_code(float v) {
  return static_cast<int>(std::clamp(v + 128.5F, 1.0F, 255.0F));  // positive: cutting it off rounds
}

/// Sum of term(d) in independent parts, so that the compiler may use vectors without reordering.
template <class Term>
float sum_over(int dimension, const Term& term) {
  constexpr int kParts = 16;
  std::array<float, kParts> parts{};
  int d = 0;
  for (; d + kParts <= dimension; d += kParts)
    for (int i = 0; i < kParts; ++i) parts[static_cast<std::size_t>(i)] += term(d + i);
  float sum = 0;
  for (; d < dimension; ++d) sum += term(d);
  for (const float part : parts) sum += part;
  return sum;
}

}  // namespace

Coder::Coder(int dimension)
    : dimension_(dimension),
      quads_(static_cast<std::size_t>(dimension + 3) / 4),
      query_scale_(kLargestProduct / (kTaughtLength + rounding_length(dimension)) -
                   rounding_length(dimension)) {}

std::size_t Coder::block_bytes() const noexcept {
  return quads_ * 4 * kBlockLanes;
}

float Coder::encode_taught(const float* row, const float* center, float scale, std::uint8_t* block,
                           std::size_t lane) const {
  const auto difference = [=](int d) { return center ? row[d] - center[d] : row[d]; };
  const float squares = sum_over(dimension_, [&](int d) { return difference(d) * difference(d); });
  if (!std::isfinite(squares)) {
    for (std::size_t d = 0; d < quads_ * 4; ++d)
      block[(d / 4 * kBlockLanes + lane) * 4 + d % 4] = 128;
    return 1;
  }
  const float length = std::sqrt(squares) * scale;
  const float factor = length > kTaughtLength ? scale * kTaughtLength / length : scale;
  const float step = 1 / scale;
  float residual = 0;
  for (std::size_t quad = 0; quad < quads_; ++quad) {
    std::uint8_t codes[4] = {128, 128, 128, 128};
    const int first = static_cast<int>(quad) * 4;
    for (int i = 0; i < std::min(4, dimension_ - first); ++i) {
      const float v = difference(first + i);
      const int code = offset_code(v * factor);
      const float error = v - static_cast<float>(code - 128) * step;
      residual += error * error;
      codes[i] = static_cast<std::uint8_t>(code);
    }
    std::memcpy(block + (quad * kBlockLanes + lane) * 4, codes, 4);
  }
  return std::sqrt(residual);
}

void Coder::decode_taught(const std::uint8_t* block, std::size_t lane, float scale,
                          float* row) const {
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension_); ++d)
    row[d] = static_cast<float>(block[(d / 4 * kBlockLanes + lane) * 4 + d % 4] - 128) / scale;
}

QueryCode Coder::encode_query(const float* row, std::int8_t* code) const {
  float largest_pair = 0;
  for (int d = 0; d < dimension_; d += 2) {
    const float pair = std::abs(row[d]) + (d + 1 < dimension_ ? std::abs(row[d + 1]) : 0.0F);
    if (std::isfinite(pair)) largest_pair = std::max(largest_pair, pair);
  }
  // Rounding adds up to 1 to the sum of a pair, which may be 128.
  const float scale =
      largest_pair > 0 ? std::min(query_scale_, 127.0F / largest_pair) : query_scale_;
  float residual = 0;
  for (int d = 0; d < dimension_; ++d) {
    const float v = std::isfinite(row[d]) ? row[d] : 0.0F;
    code[d] = static_cast<std::int8_t>(offset_code(v * scale) - 128);
    const float error = v - static_cast<float>(code[d]) / scale;
    residual += error * error;
  }
  std::fill(code + dimension_, code + quads_ * 4, std::int8_t{0});
  return {scale, std::sqrt(residual)};
}

float Coder::error(float query_residual, float taught_residual, float taught_length,
                   bool certain) const {
  if (certain) return query_residual * (taught_length + taught_residual) + taught_residual;
  return std::hypot(query_residual * taught_length, taught_residual) /
         std::sqrt(static_cast<float>(std::max(1, dimension_)));
}

const float* read_row(const cv::Mat& descriptors, int i, std::vector<float>& buffer) {
  if (descriptors.depth() == CV_32F) return descriptors.ptr<float>(i);
  buffer.resize(static_cast<std::size_t>(descriptors.cols));
  cv::hal::cvt16f32f(descriptors.ptr<cv::float16_t>(i), buffer.data(), descriptors.cols);
  return buffer.data();
}

float product(const float* a, const float* b, int dimension) {
  return sum_over(dimension, [=](int d) { return a[d] * b[d]; });
}

float distance(const float* a, const float* b, int dimension) {
  return std::sqrt(sum_over(dimension, [=](int d) { return (a[d] - b[d]) * (a[d] - b[d]); }));
}

}  // namespace posevote
