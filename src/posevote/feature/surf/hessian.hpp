// Blobs: maxima of the determinant of the box-filter Hessian in the plane and over scale
// (Bay et al. 2008, sections 3.2 to 3.4).
#pragma once

#include <array>
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

/// What the second derivatives, sums of pixels, are multiplied by: equal blobs give equal
/// determinants at all sizes, and for `size` 9 without mixed derivative that of OpenCV's SURF,
/// which divides by the area of a lobe, 15 pixels.
[[nodiscard]] constexpr float hessian_norm(int size) {
  return 81.0F / 15 / static_cast<float>(size * size);
}

/// A pixel that is larger than its 26 neighbours in an octave.
struct Candidate {
  int octave = 0, layer = 0;
  int x = 0, y = 0;  ///< px of the picture (without margin), multiples of the octave's step
  std::array<std::array<std::array<float, 3>, 3>, 3> around{};  ///< [layer][y][x], steps apart
  [[nodiscard]] float response() const { return around[1][1][1]; }
};

/// The search over all octaves; keeps its buffers between pictures.
class BlobSearch {
 public:
  void prepare(const Integral& integral, const SurfOptions& options, int team_size);
  /// Each member of a team calls this once; returns its share of the candidates of at least the
  /// threshold. The union is the same for any team; the order is not.
  const std::vector<Candidate>& search(const Member& member);

 private:
  // Every second row and column of a layer, which is a layer of the next octave too.
  struct Kept {
    int size = 0, stride = 0;
    std::vector<float> values;
  };
  struct Part {
    std::vector<float> ring;  // three rows of every layer
    std::vector<float> full;  // one row at every pixel
    std::vector<int> columns;
    std::vector<Candidate> candidates;
  };

  void prepare_kept();
  void search_octave(int octave, const Member& member, Part& part);
  void fill_row(int octave, int layer, int j, Part& part, float* row) const;
  void keep_row(int octave, int layer, int j, const float* row);
  void find_in_row(int octave, int j, Part& part) const;
  [[nodiscard]] float* ring_row(Part& part, int layer, int j) const;
  [[nodiscard]] int samples(int total, int octave) const { return ((total - 1) >> octave) + 1; }
  [[nodiscard]] int columns_of(int octave) const { return samples(width_, octave); }
  [[nodiscard]] int rows_of(int octave) const { return samples(height_, octave); }
  [[nodiscard]] int border(int octave, int layer) const;

  const Integral* integral_ = nullptr;
  SurfOptions options_;
  int width_ = 0, height_ = 0;  // of the picture, without margin
  int ring_stride_ = 0;
  std::vector<std::vector<Kept>> kept_;  // of each octave, what the one before has computed
  std::vector<Part> parts_;
};

/// The key point of a candidate: place and scale of the maximum of the quadric through the 27
/// values (Brown and Lowe 2002), angle 0. False when the maximum lies a whole step or more away.
[[nodiscard]] bool refine(const Candidate& candidate, const Integral& integral, Keypoint& keypoint);

}  // namespace posevote::surf
