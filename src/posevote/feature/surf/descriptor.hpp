// The 64 numbers that describe a key point (Bay et al. 2008, section 4.2).
#pragma once

#include "posevote/feature/features.hpp"
#include "posevote/feature/surf/integral.hpp"

namespace posevote::surf {

inline constexpr int kDescriptorSize = 64;

/// Writes the descriptor of length 1 to `descriptor[0..63]`: for each of 4 x 4 squares of side 5 s
/// (rows first, in the frame turned by the key point's angle) the sums of dx, dy, |dx|, |dy| of
/// Haar wavelets of side 2 s at a spacing of s, with a Gaussian weight of 3.3 s. A sample is shared
/// among the squares around it by bilinear weights, so that a small shift changes little. Outside
/// the picture its border is continued. A patch without any contrast gives 64 equal numbers.
void describe(const Integral& integral, const Keypoint& keypoint, float* descriptor);

}  // namespace posevote::surf
