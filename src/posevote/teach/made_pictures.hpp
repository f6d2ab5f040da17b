// Pictures made for tests: a textured background, an object on it, its shadow, another camera.
#pragma once

#include <opencv2/imgproc.hpp>

namespace posevote::made {

/// Textured ground of a warm colour: smooth random structure, BGR 8-bit.
inline cv::Mat ground(cv::Size size, double contrast = 25, int seed = 1) {
  cv::RNG random(static_cast<uint64>(seed));
  cv::Mat noise(size, CV_32F), texture;
  random.fill(noise, cv::RNG::NORMAL, 0, 1);
  cv::GaussianBlur(noise, texture, cv::Size(0, 0), 2);
  texture *= contrast / 0.14;  // a Gaussian of 2 px leaves 0.14 of white noise
  cv::Mat planes[3];
  const double base[3] = {110, 130, 150};
  for (int c = 0; c < 3; ++c) planes[c] = base[c] * (1 + texture / 130);
  cv::Mat result;
  cv::merge(planes, 3, result);
  result.convertTo(result, CV_8U);
  return result;
}

/// A box with print: bright panel with random dark and coloured patches.
inline cv::Mat box_art(cv::Size size, int seed = 7) {
  cv::RNG random(static_cast<uint64>(seed));
  cv::Mat art(size, CV_8UC3, cv::Scalar(40, 60, 200));
  for (int i = 0; i < 60; ++i) {
    const cv::Point p(random.uniform(4, size.width - 12), random.uniform(4, size.height - 12));
    const cv::Scalar colour(random.uniform(0, 255), random.uniform(0, 255), random.uniform(0, 255));
    cv::rectangle(art, cv::Rect(p, cv::Size(random.uniform(4, 10), random.uniform(4, 10))), colour,
                  cv::FILLED);
  }
  return art;
}

/// Normal noise of standard deviation `sigma`, other for every seed.
inline void add_noise(cv::Mat& image, double sigma, int seed) {
  cv::RNG random(static_cast<uint64>(seed));
  cv::Mat noise(image.size(), CV_32FC3), sum;
  random.fill(noise, cv::RNG::NORMAL, 0, sigma);
  image.convertTo(sum, CV_32F);
  sum += noise;
  sum.convertTo(image, CV_8U);
}

/// Darkens `image` to `depth` of its brightness over an ellipse with soft borders.
inline void cast_shadow(cv::Mat& image, cv::Point centre, cv::Size axes, double depth) {
  cv::Mat shade(image.size(), CV_32F, cv::Scalar(0));
  cv::ellipse(shade, centre, axes, 20, 0, 360, cv::Scalar(1), cv::FILLED);
  cv::GaussianBlur(shade, shade, cv::Size(0, 0), 4);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double s = 1 - (1 - depth) * shade.at<float>(y, x);
      for (int c = 0; c < 3; ++c) {
        auto& v = image.at<cv::Vec3b>(y, x)[c];
        v = cv::saturate_cast<uchar>(v * s);
      }
    }
  }
}

/// A background and a picture of one printed box on it, with its true mask.
struct Scene {
  cv::Mat background, picture, truth;
};

inline Scene scene(const cv::Rect& box = cv::Rect(120, 70, 80, 100), double contrast = 25) {
  Scene s;
  s.background = ground({320, 240}, contrast);
  s.picture = s.background.clone();
  box_art(box.size()).copyTo(s.picture(box));
  s.truth = cv::Mat::zeros(s.picture.size(), CV_8U);
  s.truth(box) = 255;
  add_noise(s.background, 2, 11);
  add_noise(s.picture, 2, 12);
  return s;
}

inline double iou(const cv::Mat& a, const cv::Mat& b) {
  return cv::countNonZero(a & b) / static_cast<double>(std::max(1, cv::countNonZero(a | b)));
}

}  // namespace posevote::made
