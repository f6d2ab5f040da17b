// The direction of a key point (Bay et al. 2008, section 4.1).
#pragma once

#include "posevote/feature/features.hpp"
#include "posevote/feature/surf/integral.hpp"

namespace posevote::surf {

/// Direction of the largest sum of Haar-wavelet responses (side 6 s, at 8 x 8 points 1.5 s apart,
/// Gaussian weight of 3 s) that falls into a 60-degree sector, of which 72 are tried; radians in
/// [-pi, pi). Wavelets that reach past the margin are left out.
[[nodiscard]] float orientation(const Integral& integral, const Keypoint& keypoint);

}  // namespace posevote::surf
