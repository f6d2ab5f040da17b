#include "posevote/feature/surf/integral.hpp"

#include <algorithm>

namespace posevote::surf {

void Integral::compute(const cv::Mat& grey) {
  width_ = grey.cols;
  height_ = grey.rows;
  stride_ = static_cast<std::size_t>(width_) + 1;
  sums_.resize(stride_ * (height_ + 1));
  std::fill_n(sums_.begin(), stride_, 0U);
  for (int y = 0; y < height_; ++y) {
    const std::uint8_t* pixels = grey.ptr<std::uint8_t>(y);
    const std::uint32_t* above = &sums_[y * stride_];
    std::uint32_t* row = &sums_[(y + 1) * stride_];
    row[0] = 0;
    std::uint32_t sum = 0;
    for (int x = 0; x < width_; ++x) {
      sum += pixels[x];
      row[x + 1] = above[x + 1] + sum;
    }
  }
}

}  // namespace posevote::surf
