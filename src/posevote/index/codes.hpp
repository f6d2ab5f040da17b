// Descriptors as 8-bit codes whose scalar products fit in 16 bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace posevote {

/// A descriptor of the scene as a code. `dots` of it and a taught code, over `scale` and the taught
/// code's scale, is about the scalar product of what they stand for.
struct QueryCode {
  float scale = 0;
  float residual = 0;       ///< length of (descriptor - what the code stands for)
  float lost = 0;           ///< product of (descriptor - what the code stands for) and descriptor
  std::int32_t offset = 0;  ///< 128 * sum of the code
};

/// Scale of taught values that lie in [-1, 1]; none is cut.
inline constexpr float kUnitScale = 127;

/// Codes of descriptors of one dimension. A taught value v becomes round(v * scale) + 128 in one
/// byte, with one scale for many descriptors; a query value round(v * scale) with a scale of its
/// own. Both are limited so that the conditions of `dots` hold and the products fit in 16 bits.
/// A taught row with values that are not finite is coded as 0, such values of a query too.
class Coder {
 public:
  explicit Coder(int dimension);

  [[nodiscard]] int dimension() const noexcept { return dimension_; }
  [[nodiscard]] std::size_t quads() const noexcept { return quads_; }
  [[nodiscard]] std::size_t block_bytes() const noexcept;
  /// Writes `row` - `center` (null: 0) into lane `lane` of a block of kBlockLanes (see dots.hpp).
  /// Values beyond 127 are cut and longer codes than the limit shortened; see the residual that is
  /// returned: the length of (row - center - what the code stands for).
  float encode_taught(const float* row, const float* center, float scale, std::uint8_t* block,
                      std::size_t lane) const;

  /// Codes of rows without a centre and with kUnitScale, in blocks as `dots` reads them. Lanes
  /// beyond the last row hold 0.
  [[nodiscard]] std::vector<std::uint8_t> encode_all(const std::vector<const float*>& rows) const;

  /// What encode_taught wrote without a centre, as floats.
  void decode_taught(const std::uint8_t* block, std::size_t lane, float scale, float* row) const;

  /// Writes quads() * 4 bytes.
  QueryCode encode_query(const float* row, std::int8_t* code) const;

  /// How far the scalar product of two codes may be from that of what they stand for, which have
  /// length 1 and `taught_length`: never farther when `certain`, else as far as one standard
  /// deviation of the rounding of both.
  [[nodiscard]] float error(float query_residual, float taught_residual, float taught_length,
                            bool certain) const;

 private:
  int dimension_;
  std::size_t quads_;
  float query_scale_;
};

/// Row i of descriptors of type CV_32F or CV_16F as floats; `buffer` is used when needed.
[[nodiscard]] const float* read_row(const cv::Mat& descriptors, int i, std::vector<float>& buffer);

/// Scalar product, summed in one fixed order.
[[nodiscard]] float product(const float* a, const float* b, int dimension);

}  // namespace posevote
