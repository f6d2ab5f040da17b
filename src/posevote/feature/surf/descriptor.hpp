// The 64 numbers that describe a key point (Bay et al. 2008, section 4.2).
#pragma once

#include "posevote/feature/features.hpp"
#include "posevote/feature/surf/integral.hpp"

namespace posevote::surf {

using simd::kDescriptorSize;

/// Writes the descriptor of length 1 to `descriptor[0..63]`: for each of 4 x 4 squares (rows first,
/// in the frame turned by the key point's angle) the sums of dx, dy, |dx|, |dy| of Haar wavelets of
/// side 10/3 s at a spacing of 5/3 s. The squares are 10 s wide and overlap by half, with a
/// Gaussian of 2.5 s around the centre of each and one of 1.5 squares over all (Agrawal et al.,
/// ECCV 2008), so that a small shift changes little. A patch without any contrast gives 64 equal
/// numbers.
void describe(const Integral& integral, const Keypoint& keypoint, float* descriptor);

}  // namespace posevote::surf
