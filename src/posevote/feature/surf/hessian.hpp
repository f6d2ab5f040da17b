// Blobs: maxima of the determinant of the box-filter Hessian in the plane and over scale
// (Bay et al. 2008, sections 3.2 to 3.4).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "posevote/feature/features.hpp"
#include "posevote/feature/surf/integral.hpp"

namespace posevote::surf {

/// Octave k searches level k of the integral with the filters of octave 0: of side 9, 15, 21, 27,
/// ... pixels of the level.
[[nodiscard]] constexpr int lobe_of(int layer) {
  return 2 * layer + 3;
}
/// Side of the box filter of a layer, px of the picture.
[[nodiscard]] constexpr int filter_size(int octave, int layer) {
  return 3 * lobe_of(layer) << octave;
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

/// A place where the larger determinant of two layers (a pair: 1 and 2, 3 and 4, ...) is larger
/// than at its eight neighbours; of equal neighbours the last one, so that a blob halfway between
/// two samples is found.
struct Peak {
  float response = 0;
  std::int16_t octave = 0, layer = 0;  ///< the lower one of the pair
  int x = 0, y = 0;                    ///< px of the octave's level, with margin
};

/// A place and layer where the determinant is larger than its 26 neighbours'.
struct Candidate {
  int octave = 0, layer = 0;
  int x = 0, y = 0;  ///< px of the octave's level, with margin
  std::array<std::array<std::array<float, 3>, 3>, 3> around{};  ///< [layer][y][x]
  [[nodiscard]] float response() const { return around[1][1][1]; }
};

/// The search over all octaves; keeps its buffers between pictures. Only the layers in which key
/// points are looked for are filled; those above and below are computed where a peak is examined.
class BlobSearch {
 public:
  /// Finds all peaks of at least the threshold. `integral` must have a level for each octave.
  void search(const Integral& integral, const SurfOptions& options, Team& team, int threads);
  /// Calls visit(Peak) for each by octave, pair, y, x: the same order for any number of threads.
  template <class Visit>
  void for_each_peak(Visit&& visit) const {
    for (int b = 0; b < blocks_used_; ++b)
      for (const Peak& peak : blocks_[b].peaks) visit(peak);
  }

 private:
  struct Block {
    int octave = 0, layer = 0;
    int begin = 0, end = 0;  // rows
    std::vector<Peak> peaks;
  };
  struct Buffers {
    std::vector<float> ring;  // three rows
    std::vector<int> columns;
  };

  void cut_into_blocks(int threads);
  void search_block(Block& block, Buffers& buffers) const;

  const Integral* integral_ = nullptr;
  SurfOptions options_;
  std::ptrdiff_t stride_ = 0;  // of a ring's rows
  std::vector<Block> blocks_;
  int blocks_used_ = 0;  // the others keep their room
  std::vector<Buffers> buffers_;
  std::vector<int> by_place_;  // the blocks from top to bottom of the picture
};

/// The layer and the 27 values of a peak; nothing when a neighbour is larger.
[[nodiscard]] std::optional<Candidate> examine(const Peak& peak, const Integral& integral,
                                               const SurfOptions& options);

/// The key point of a candidate: place and scale of the maximum of the quadric through the 27
/// values (Brown and Lowe 2002), angle 0. Nothing when the maximum lies a whole step or more away.
[[nodiscard]] std::optional<Keypoint> refine(const Candidate& candidate, const Integral& integral);

}  // namespace posevote::surf
