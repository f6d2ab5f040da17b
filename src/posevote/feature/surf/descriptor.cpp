#include "posevote/feature/surf/descriptor.hpp"

#include <algorithm>
#include <cmath>

namespace posevote::surf {

int sample_side(const Integral& integral, float scale) {
  const int limit = std::min(integral.width(), integral.height());
  return std::clamp(static_cast<int>(std::lround(scale)), 1, limit);
}

void BoxSums::prepare(const Integral& integral, const std::vector<Keypoint>& keypoints) {
  integral_ = &integral;
  std::array<int, kLargestSide + 1> count{};
  for (const Keypoint& keypoint : keypoints) {
    const int side = sample_side(integral, keypoint.scale);
    if (side <= kLargestSide) ++count[side];
  }
  // Making the sums of 2000 boxes takes about as long as they save for one key point.
  const int pixels = integral.width() * integral.height();
  for (int side = 1; side <= kLargestSide; ++side) {
    wanted_[side] = count[side] > pixels / 2000;
    if (wanted_[side]) boxes_[side].resize(static_cast<std::size_t>(pixels));
  }
}

void BoxSums::compute(const Member& member) {
  const int width = integral_->width();
  for (int side = 1; side <= kLargestSide; ++side) {
    if (!wanted_[side]) continue;
    const int rows = integral_->height() - side + 1;
    for (int y = member.begin(rows); y < member.end(rows); ++y)
      simd::box_row(integral_->view(), y, side, width - side + 1,
                    &boxes_[side][static_cast<std::size_t>(y) * width]);
  }
  member.wait();
}

simd::BoxesView BoxSums::view(int side) const {
  if (side > kLargestSide || !wanted_[side]) return {};
  return {boxes_[side].data(), integral_->width()};
}

void describe(const Integral& integral, const BoxSums& boxes, const Keypoint& keypoint,
              float* descriptor) {
  const simd::PatchFrame frame{
      keypoint.x + kMargin, keypoint.y + kMargin, keypoint.scale * std::cos(keypoint.angle),
      keypoint.scale * std::sin(keypoint.angle), sample_side(integral, keypoint.scale)};
  simd::descriptor(integral.view(), boxes.view(frame.side), frame, descriptor);
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
