// Which of two look-alikes stands in a place? The parts in which they differ decide.
#pragma once

#include "posevote/verify/agreement.hpp"

namespace posevote {

/// A view's picture under a pose.
struct PlacedPatch {
  const Patch& patch;
  cv::Matx33d scene_from_view;
};

/// Puts both pictures into the scene and compares the scene with each of them where they differ
/// from each other, in brightness and colour; the light is taken from their common area. In
/// [-1, 1]: 1 when the scene is `a`'s picture, -1 when it is `b`'s, 0 when it is as far from both,
/// or when nothing tells them apart or a patch is empty.
[[nodiscard]] double discriminate(const PlacedPatch& a, const PlacedPatch& b,
                                  const ScenePyramid& scene);

}  // namespace posevote
