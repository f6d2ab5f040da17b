// Pictures made for tests: deterministic, no files.
#pragma once

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace posevote::made {

/// Texture with structure at many sizes, 8-bit grey.
inline cv::Mat texture(int width, int height, unsigned seed = 7) {
  cv::RNG random(seed);
  cv::Mat sum = cv::Mat::zeros(height, width, CV_32F);
  for (const double sigma : {1.5, 3.0, 6.0, 12.0}) {
    cv::Mat noise(height, width, CV_32F);
    random.fill(noise, cv::RNG::NORMAL, 0, 1);
    cv::GaussianBlur(noise, noise, {}, sigma);
    sum += noise * sigma;
  }
  cv::Mat grey;
  cv::normalize(sum, grey, 0, 255, cv::NORM_MINMAX, CV_8U);
  return grey;
}

/// A Gaussian spot of standard deviation `sigma` px at (x, y), dark on grey or bright on grey.
inline cv::Mat spot(int width, int height, double x, double y, double sigma, bool dark) {
  cv::Mat grey(height, width, CV_8U);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const double d2 = (i - x) * (i - x) + (j - y) * (j - y);
      const double bump = 100 * std::exp(-d2 / (2 * sigma * sigma));
      grey.at<std::uint8_t>(j, i) = cv::saturate_cast<std::uint8_t>(128 + (dark ? -bump : bump));
    }
  return grey;
}

}  // namespace posevote::made
