// The 64 numbers that describe a key point (Bay et al. 2008, section 4.2).
#pragma once

#include <array>
#include <vector>

#include "posevote/feature/features.hpp"
#include "posevote/feature/surf/integral.hpp"

namespace posevote::surf {

using simd::kDescriptorSize;

/// Side of the boxes that are sampled for a key point, px.
[[nodiscard]] int sample_side(const Integral& integral, float scale);

/// The sums of all boxes of the sides that many key points need: made once, they save three of four
/// look-ups per sample. Makes no difference to any result. Keeps its buffers between pictures.
class BoxSums {
 public:
  /// Decides which sides are worth it; `integral` and the buffers must outlive the use.
  void prepare(const Integral& integral, const std::vector<Keypoint>& keypoints);
  /// Each member of a team calls this once; ready when all have returned.
  void compute(const Member& member);
  [[nodiscard]] simd::BoxesView view(int side) const;

 private:
  static constexpr int kLargestSide = 16;  // 16 x 16 x 255 still fits
  const Integral* integral_ = nullptr;
  std::array<std::vector<std::uint16_t>, kLargestSide + 1> boxes_;
  std::array<bool, kLargestSide + 1> wanted_{};
};

/// Writes the descriptor of length 1 to `descriptor[0..63]`: for each of 4 x 4 squares (rows first,
/// in the frame turned by the key point's angle) the sums of dx, dy, |dx|, |dy| of Haar wavelets of
/// side 2 s at a spacing of s. The squares are 9 s wide and overlap by 4 s, with a Gaussian of 2.5
/// s around the centre of each and one of 1.5 squares over all (Agrawal et al., ECCV 2008), so that
/// a small shift changes little. A patch without any contrast gives 64 equal numbers.
void describe(const Integral& integral, const BoxSums& boxes, const Keypoint& keypoint,
              float* descriptor);

}  // namespace posevote::surf
