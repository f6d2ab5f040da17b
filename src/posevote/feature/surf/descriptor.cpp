#include "posevote/feature/surf/descriptor.hpp"

#include <algorithm>
#include <cmath>

namespace posevote::surf {
namespace {

constexpr float kSpacing = 5.0F / 3;  // of the boxes and their side, scales

}  // namespace

void describe(const Integral& integral, const Keypoint& keypoint, float* descriptor) {
  const float spacing = kSpacing * keypoint.scale;
  const int largest = std::min(integral.width(), integral.height());
  const int side = std::clamp(static_cast<int>(std::lround(spacing)), 1, largest);
  const simd::PatchFrame frame{keypoint.x + kMargin, keypoint.y + kMargin,
                               spacing * std::cos(keypoint.angle),
                               spacing * std::sin(keypoint.angle), side};
  simd::descriptor(integral.view(), frame, descriptor);
}

}  // namespace posevote::surf
