// How the background picture would look in the light and place of the object's picture, and how
// much noise separates the two: the measure of every later decision.
#pragma once

#include <array>
#include <opencv2/core.hpp>

namespace posevote {

/// Standard deviation of (picture - expected background) where nothing has changed: a function of
/// the brightness, plus what a small displacement makes of the background's own edges.
struct NoiseModel {
  static constexpr int kLevels = 17;                     ///< brightness 0, 16, .. 256
  std::array<std::array<float, kLevels>, 3> sigma = {};  ///< per channel (BGR), 8-bit levels
  float jitter_px = 0;  ///< displacement that explains the excess residual at edges

  /// CV_32FC3 variance for every pixel of `expected` (CV_32FC3).
  [[nodiscard]] cv::Mat variance(const cv::Mat& expected) const;
};

/// The background picture brought into agreement with the object's picture.
struct BackgroundFit {
  cv::Mat expected;                   ///< CV_32FC3: shifted, gain * background + offset
  std::array<double, 3> gain = {};    ///< per channel (BGR): exposure and white balance
  std::array<double, 3> offset = {};  ///< per channel, 8-bit levels
  cv::Point2d shift;                  ///< px: expected(p) is taken from the background at p - shift
  NoiseModel noise;
  /// Correlation of the two pictures' fine structure, [-1, 1]: median over blocks along the border
  /// in which the background has more structure than noise; 1 if there are too few.
  double texture_agreement = 1;
};

/// Fits gain and offset per channel and a small shift by iteratively re-weighted least squares
/// (Tukey's weight), started in a frame along the border, where the object is not expected; then
/// measures the noise. `picture` and `background`: CV_32FC3 in 8-bit levels, same size, at least
/// 1x1.
[[nodiscard]] BackgroundFit fit_background(const cv::Mat& picture, const cv::Mat& background);

/// The same fit for a copy of the two pictures that is `scale` times larger: only the noise is
/// measured anew.
[[nodiscard]] BackgroundFit transfer_fit(const BackgroundFit& fit, double scale,
                                         const cv::Mat& picture, const cv::Mat& background);

/// CV_8U: 255 in a frame along the border, `share` of the shorter side wide (at least 1 px).
[[nodiscard]] cv::Mat border_frame(cv::Size size, double share);

}  // namespace posevote
