// The direction of a key point (Bay et al. 2008, section 4.1).
#pragma once

#include "posevote/feature/features.hpp"
#include "posevote/feature/surf/integral.hpp"

namespace posevote::surf {

/// Direction of the largest sum of Haar-wavelet responses (side 4 s, at 109 points within 6 s,
/// Gaussian weight of 2 s) that falls into any 60-degree sector; radians in [-pi, pi).
/// Wavelets that do not fit into the picture are left out.
[[nodiscard]] float orientation(const Integral& integral, const Keypoint& keypoint);

}  // namespace posevote::surf
