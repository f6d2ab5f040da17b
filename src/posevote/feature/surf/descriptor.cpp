#include "posevote/feature/surf/descriptor.hpp"

#include <algorithm>
#include <cmath>

namespace posevote::surf {

void describe(const Integral& integral, const Keypoint& keypoint, float* descriptor) {
  const int limit = std::min(integral.width(), integral.height());
  const simd::PatchFrame frame{keypoint.x + kMargin, keypoint.y + kMargin,
                               keypoint.scale * std::cos(keypoint.angle),
                               keypoint.scale * std::sin(keypoint.angle),
                               std::clamp(static_cast<int>(std::lround(keypoint.scale)), 1, limit)};
  simd::descriptor(integral.view(), frame, descriptor);
  float sum = 0;
  for (int i = 0; i < kDescriptorSize; ++i) sum += descriptor[i] * descriptor[i];
  if (!(sum > 0)) {
    std::fill_n(descriptor, kDescriptorSize, 0.125F);
    return;
  }
  const float scale = 1 / std::sqrt(sum);
  for (int i = 0; i < kDescriptorSize; ++i) descriptor[i] *= scale;
}

}  // namespace posevote::surf
