// Blobs: maxima of the determinant of the box-filter Hessian in the plane and over scale
// (Bay et al. 2008, sections 3.2 to 3.4).
#pragma once

#include <cstdint>
#include <vector>

#include "posevote/feature/features.hpp"
#include "posevote/feature/surf/integral.hpp"

namespace posevote::surf {

/// Side of the box filter of a layer, px: 9, 15, 21, 27, ... in octave 0; 15, 27, 39, ... in
/// octave 1.
[[nodiscard]] constexpr int filter_size(int octave, int layer) {
  return 3 * ((2 << octave) * (layer + 1) + 1);
}
/// Standard deviation of the Gaussian that a box filter stands for, px.
[[nodiscard]] constexpr float scale_of_filter(float size) {
  return size * (1.2F / 9);
}

/// The three second derivatives as plain sums of pixels, each times the size of the filter's area.
struct SecondDerivatives {
  std::int32_t xx, yy, xy;
};

/// Precondition: the filter of `size` (9, 15, ...) around pixel (x, y) lies inside the picture.
[[nodiscard]] SecondDerivatives second_derivatives(const Integral& integral, int size, int x,
                                                   int y);

/// Determinant of the Hessian; scaled so that equal blobs give equal values at all sizes, and that
/// the value for `size` 9 is that of OpenCV's SURF where `xy` is 0.
[[nodiscard]] float hessian_determinant(const SecondDerivatives& derivatives, int size);

/// All maxima above `threshold`, interpolated; angle 0. In scan order of octave, layer, y, x.
[[nodiscard]] std::vector<Keypoint> find_blobs(const Integral& integral,
                                               const SurfOptions& options);

}  // namespace posevote::surf
