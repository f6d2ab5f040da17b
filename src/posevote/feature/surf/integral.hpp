// Sums over rectangles of a picture in constant time (Bay et al. 2008, section 3.1).
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "posevote/feature/simd/kernels.hpp"
#include "posevote/feature/surf/team.hpp"

namespace posevote::surf {

/// The summed picture has a border of kMargin pixels all round that continues the outermost pixels:
/// filters near the border see no edge there. Pixel (x, y) of the picture is (x + kMargin,
/// y + kMargin) of the summed one; all coordinates below are those of the summed one.
inline constexpr int kMargin = 32;

/// at(y, x) is the sum of the pixels in the rows above y and the columns left of x, modulo 2^32:
/// differences are exact as long as the rectangle's own sum is below 2^32.
///
/// Level k > 0 holds the same sums at every 2^k-th row and column only: a picture whose pixels are
/// the sums of 2^k x 2^k pixels of the summed one. What is left over at the right and below is cut.
class Integral {
 public:
  /// The same for any number of threads. `grey`: CV_8UC1, not empty, not kept. Keeps the buffers of
  /// earlier pictures.
  void compute(const cv::Mat& grey, bool smooth, int levels, Team& team, int threads);

  [[nodiscard]] int width() const noexcept { return levels_[0].width; }    ///< px, with margins
  [[nodiscard]] int height() const noexcept { return levels_[0].height; }  ///< px, with margins
  [[nodiscard]] std::uint32_t at(int y, int x) const {
    return levels_[0].sums[y * levels_[0].stride + x];
  }
  /// Sum of the pixels x0 <= x < x1, y0 <= y < y1. Precondition: 0 <= x0 <= x1 <= width, same for
  /// y.
  [[nodiscard]] std::uint32_t box(int x0, int y0, int x1, int y1) const {
    return at(y1, x1) - at(y1, x0) - at(y0, x1) + at(y0, x0);
  }
  [[nodiscard]] simd::SumsView view(int level = 0) const {
    const Level& of = levels_[level];
    return {of.sums.data(), of.stride, of.width, of.height};
  }

 private:
  struct Level {
    int width = 0, height = 0;  // px of this level, with margins
    std::ptrdiff_t stride = 0;
    std::vector<std::uint32_t> sums;
    [[nodiscard]] std::uint32_t* row(int y) { return &sums[y * stride]; }
  };
  // Of a thread.
  struct Buffers {
    std::vector<std::uint16_t> scratch;
  };

  void prepare(const cv::Mat& grey, bool smooth, int levels, int threads);
  void fill_row(int y, std::uint16_t* scratch, std::uint8_t* row) const;
  void fill_levels(int y);
  void sum_row(int y, const std::uint8_t* pixels);
  void sum_all(Buffers& buffers);
  [[nodiscard]] int block_begin(int number) const;
  [[nodiscard]] std::uint8_t* pixels(int y) {
    return &pixels_[static_cast<std::size_t>(y) * width()];
  }
  void load_block(int number, Buffers& buffers);
  void sum_blocks();
  void sum_block(int number);

  cv::Mat grey_;
  bool smooth_ = false;
  int blocks_ = 1;
  std::vector<Level> levels_ = std::vector<Level>(1);
  std::vector<Buffers> buffers_;
  std::vector<std::uint8_t> pixels_;    // with margins: all rows where threads share, else one
  std::vector<std::uint16_t> columns_;  // sums of each block's columns
  std::vector<std::uint32_t> above_;    // sums of the columns above a row
};

}  // namespace posevote::surf
