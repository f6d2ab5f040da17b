// Sums over rectangles of a picture in constant time (Bay et al. 2008, section 3.1).
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace posevote::surf {

/// at(y, x) is the sum of the pixels in the rows above y and the columns left of x, modulo 2^32:
/// differences are exact as long as the rectangle's own sum is below 2^32.
class Integral {
 public:
  /// `grey`: CV_8UC1, not empty.
  void compute(const cv::Mat& grey);

  [[nodiscard]] int width() const noexcept { return width_; }    ///< px
  [[nodiscard]] int height() const noexcept { return height_; }  ///< px
  [[nodiscard]] std::uint32_t at(int y, int x) const {
    return sums_[static_cast<std::size_t>(y) * stride_ + x];
  }
  /// Sum of the pixels x0 <= x < x1, y0 <= y < y1. Precondition: 0 <= x0 <= x1 <= width, same for
  /// y.
  [[nodiscard]] std::uint32_t box(int x0, int y0, int x1, int y1) const {
    return at(y1, x1) - at(y1, x0) - at(y0, x1) + at(y0, x0);
  }

 private:
  int width_ = 0, height_ = 0;
  std::size_t stride_ = 0;
  std::vector<std::uint32_t> sums_;
};

}  // namespace posevote::surf
