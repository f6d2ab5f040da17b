#include "posevote/index/codes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core/hal/hal.hpp>

#include "posevote/index/dots.hpp"
#include "posevote/index/sums.hpp"

namespace posevote {
namespace {

// The scalar product of two codes, which is at most the product of their lengths, fits in 16 bits.
constexpr float kLargestProduct = 32767;
constexpr float kTaughtLength = 150;

/// By how much rounding can lengthen a code.
float rounding_length(int dimension) {
  return std::sqrt(static_cast<float>(dimension)) / 2;
}

/// Is the sum of the magnitudes a number?
bool is_finite(const float* row, std::size_t count) {
  return std::isfinite(sum_over(count, [=](std::size_t d) { return std::abs(row[d]); }));
}

/// Largest |a| + |b| of the pairs (2j, 2j + 1).
float largest_pair(const float* row, std::size_t count) {
  constexpr std::size_t kParts = 8;
  float parts[kParts] = {};
  std::size_t d = 0;
  for (; d + 2 * kParts <= count; d += 2 * kParts)
    for (std::size_t i = 0; i < kParts; ++i) {
      const float pair = std::abs(row[d + 2 * i]) + std::abs(row[d + 2 * i + 1]);
      parts[i] = parts[i] < pair ? pair : parts[i];
    }
  float largest = 0;
  for (; d < count; d += 2)
    largest = std::max(largest, std::abs(row[d]) + (d + 1 < count ? std::abs(row[d + 1]) : 0.0F));
  for (const float part : parts) largest = std::max(largest, part);
  return largest;
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
  const auto size = static_cast<std::size_t>(dimension_);
  const auto difference = [=](std::size_t d) { return center ? row[d] - center[d] : row[d]; };
  const float squares =
      sum_over(size, [&](std::size_t d) { return difference(d) * difference(d); });
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
    const std::size_t first = quad * 4;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, size - first); ++i) {
      const float v = difference(first + i);
      const int code = round_to_code(v * factor) + 128;
      const float error = v - static_cast<float>(code - 128) * step;
      residual += error * error;
      codes[i] = static_cast<std::uint8_t>(code);
    }
    std::memcpy(block + (quad * kBlockLanes + lane) * 4, codes, 4);
  }
  return std::sqrt(residual);
}

std::vector<std::uint8_t> Coder::encode_all(const std::vector<const float*>& rows) const {
  const std::size_t blocks = (rows.size() + kBlockLanes - 1) / kBlockLanes;
  std::vector<std::uint8_t> codes(blocks * block_bytes(), 128);
  for (std::size_t i = 0; i < rows.size(); ++i)
    encode_taught(rows[i], nullptr, kUnitScale, &codes[i / kBlockLanes * block_bytes()],
                  i % kBlockLanes);
  return codes;
}

void Coder::decode_taught(const std::uint8_t* block, std::size_t lane, float scale,
                          float* row) const {
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension_); ++d) {
    const int code = block[(d / 4 * kBlockLanes + lane) * 4 + d % 4];
    row[d] = static_cast<float>(code - 128) / scale;
  }
}

QueryCode Coder::encode_query(const float* row, std::int8_t* code) const {
  const auto size = static_cast<std::size_t>(dimension_);
  std::vector<float> cleaned;
  if (!is_finite(row, size)) {
    cleaned.assign(row, row + size);
    for (float& v : cleaned) v = std::isfinite(v) ? v : 0.0F;
    row = cleaned.data();
  }
  const float pair = largest_pair(row, size);
  // Rounding adds up to 1 to the sum of a pair, which may be 128.
  const float scale = pair > 0 ? std::min(query_scale_, 127.0F / pair) : query_scale_;
  std::fill(code + size, code + quads_ * 4, std::int8_t{0});
  const Rounding rounding = encode(row, size, scale, code);
  QueryCode result;
  result.scale = scale;
  result.residual = std::sqrt(rounding.squares);
  result.lost = rounding.lost;
  result.offset = 128 * rounding.sum;
  return result;
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
  return sum_over(static_cast<std::size_t>(dimension), [=](std::size_t d) { return a[d] * b[d]; });
}

}  // namespace posevote
