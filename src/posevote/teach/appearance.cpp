#include "posevote/teach/appearance.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "posevote/core/options.hpp"

namespace posevote {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr float kAnyColour = 1.0F / (256.F * 256.F * 256.F);
constexpr int kBins = 32;
constexpr float kBinWidth = 256.F / kBins;

cv::Mat blurred(const cv::Mat& image, double sigma) {
  cv::Mat result;
  cv::GaussianBlur(image, result, cv::Size(0, 0), sigma);
  return result;
}

// log of how plausible a shading of a background of brightness `level` is: flat between the deepest
// shadow and 1. Below, black is black: a few levels say nothing.
double log_prior_of_shading(double s, double level, const ShadowOptions& options) {
  constexpr double kBlackLevels = 4;
  if (s > 1) return -0.5 * std::pow((s - 1) / options.brighter, 2);
  const double below = (options.deepest - s) * level / kBlackLevels;
  return below > 0 ? -0.5 * below * below : 0;
}

// Density of colour `p` for a background `b` whose shading is near `shading`: normal about the line
// s * b in the plane across it, and along it about the shading of the surroundings. Near black the
// colour is the camera's: its offset, stray light and JPEG.
double shadow_density(const cv::Vec3f& p, const cv::Vec3f& b, const cv::Vec3f& variance,
                      double shading, const ShadowOptions& options) {
  constexpr double kOffset = 1, kDark = 16;  // levels
  const double level = shading * (b[0] + b[1] + b[2]) / 3;
  const double offset = kOffset * std::clamp(1 - level / kDark, 0.0, 1.0);
  double up = 0, uu = 0, pp = 0, volume = 1;
  for (int c = 0; c < 3; ++c) {
    const double tint = options.tint * shading * b[c];
    const double q2 = variance[c] * 0.5 * (1 + shading * shading) + tint * tint + offset * offset;
    up += p[c] * b[c] / q2;
    uu += b[c] * b[c] / q2;
    pp += p[c] * p[c] / q2;
    volume *= std::sqrt(q2);
  }
  if (uu < 1e-6) return 0;
  const double s = up / uu;
  const double across = std::max(0.0, pp - s * up);
  const double spread2 = 1 / uu + options.unevenness * options.unevenness;
  const double along = (s - shading) * (s - shading) / spread2;
  const double log_density =
      -0.5 * (across + along) + log_prior_of_shading(shading, (b[0] + b[1] + b[2]) / 3, options);
  return std::exp(log_density) / (std::pow(kTwoPi, 1.5) * volume * std::sqrt(uu * spread2));
}

double lit_density(const cv::Vec3f& p, const cv::Vec3f& b, const cv::Vec3f& variance) {
  double distance = 0, volume = 1;
  for (int c = 0; c < 3; ++c) {
    distance += (p[c] - b[c]) * (p[c] - b[c]) / variance[c];
    volume *= variance[c];
  }
  return std::exp(-0.5 * distance) / (std::pow(kTwoPi, 1.5) * std::sqrt(volume));
}

}  // namespace

void ShadowOptions::describe(OptionList& list) {
  list.add("deepest", deepest, {0.01, 1}, "",
           "Share of the brightness left in the darkest shadow.");
  list.add("tint", tint, {0, 1}, "", "Relative change of colour within a shadow.");
  list.add("brighter", brighter, {0.001, 1}, "",
           "How far the object may brighten its surroundings.");
  list.add("unevenness", unevenness, {0.001, 1}, "", "Change of a shadow's depth over its window.");
  list.add("window_px", window_px, {0.5, 50}, "px", "Size of the window that measures a shadow.");
}

cv::Mat estimate_shading(const cv::Mat& picture, const cv::Mat& expected, const cv::Mat& variance,
                         const cv::Mat& weight, const ShadowOptions& options) {
  cv::Mat across(picture.size(), CV_32F), own(picture.size(), CV_32F);
  for (int y = 0; y < picture.rows; ++y) {
    const auto* p = picture.ptr<cv::Vec3f>(y);
    const auto* b = expected.ptr<cv::Vec3f>(y);
    const auto* v = variance.ptr<cv::Vec3f>(y);
    const auto* w = weight.ptr<float>(y);
    for (int x = 0; x < picture.cols; ++x) {
      float pb = 0, bb = 0;
      for (int c = 0; c < 3; ++c) {
        pb += p[x][c] * b[x][c] / v[x][c];
        bb += b[x][c] * b[x][c] / v[x][c];
      }
      across.at<float>(y, x) = w[x] * pb;
      own.at<float>(y, x) = w[x] * bb;
    }
  }
  // A far wider window stands in where the near one holds no background; a trace of s = 1 below
  // all.
  const cv::Mat near_pb = blurred(across, options.window_px),
                near_bb = blurred(own, options.window_px);
  const cv::Mat far_pb = blurred(across, 4 * options.window_px);
  const cv::Mat far_bb = blurred(own, 4 * options.window_px);
  constexpr double kFar = 0.02, kNone = 1e-3;
  cv::Mat shading;
  cv::divide(near_pb + kFar * far_pb + kNone, near_bb + kFar * far_bb + kNone, shading);
  return shading;
}

cv::Mat background_log_likelihood(const cv::Mat& picture, const cv::Mat& expected,
                                  const cv::Mat& variance, const cv::Mat& shading,
                                  const ShadowOptions& options) {
  constexpr double kLit = 0.5, kShadow = 0.5;
  constexpr double kOutlier =
      1e-3;  // a background pixel of any colour: caps the evidence at 7 nats
  cv::Mat result(picture.size(), CV_32F);
  for (int y = 0; y < picture.rows; ++y) {
    const auto* p = picture.ptr<cv::Vec3f>(y);
    const auto* b = expected.ptr<cv::Vec3f>(y);
    const auto* v = variance.ptr<cv::Vec3f>(y);
    const auto* s = shading.ptr<float>(y);
    auto* r = result.ptr<float>(y);
    for (int x = 0; x < picture.cols; ++x) {
      const double density = kLit * lit_density(p[x], b[x], v[x]) +
                             kShadow * shadow_density(p[x], b[x], v[x], s[x], options) +
                             kOutlier * kAnyColour;
      r[x] = static_cast<float>(std::log(density));
    }
  }
  return result;
}

cv::Mat plain_log_likelihood(const cv::Mat& picture, const cv::Mat& variance,
                             const ShadowOptions& options) {
  const cv::Mat mean = blurred(picture, options.window_px);
  cv::Mat result(picture.size(), CV_32F);
  for (int y = 0; y < picture.rows; ++y) {
    const auto* p = picture.ptr<cv::Vec3f>(y);
    const auto* m = mean.ptr<cv::Vec3f>(y);
    const auto* v = variance.ptr<cv::Vec3f>(y);
    for (int x = 0; x < picture.cols; ++x) {
      result.at<float>(y, x) = static_cast<float>(
          std::log(shadow_density(p[x], m[x], v[x], 1, options) + 1e-3 * kAnyColour));
    }
  }
  return result;
}

ObjectColours::ObjectColours(const cv::Mat& picture, const cv::Mat& sure) {
  const int sizes[] = {kBins, kBins, kBins};
  cv::Mat counts = cv::Mat::zeros(3, sizes, CV_32F);
  double total = 0;
  for (int y = 0; y < picture.rows; ++y) {
    const auto* p = picture.ptr<cv::Vec3f>(y);
    const auto* m = sure.ptr<uchar>(y);
    for (int x = 0; x < picture.cols; ++x) {
      if (!m[x]) continue;
      int bin[3];
      for (int c = 0; c < 3; ++c) bin[c] = std::clamp(cvFloor(p[x][c] / kBinWidth), 0, kBins - 1);
      counts.at<float>(bin) += 1;
      total += 1;
    }
  }
  if (total == 0) return;
  // Binomial smoothing (1 2 1) / 4 along each axis.
  for (int axis = 0; axis < 3; ++axis) {
    cv::Mat smooth = cv::Mat::zeros(3, sizes, CV_32F);
    for (int i = 0; i < kBins; ++i) {
      for (int j = 0; j < kBins; ++j) {
        for (int k = 0; k < kBins; ++k) {
          const int at[] = {i, j, k};
          float sum = 0.5F * counts.at<float>(at);
          for (const int step : {-1, 1}) {
            int other[] = {i, j, k};
            other[axis] = std::clamp(other[axis] + step, 0, kBins - 1);
            sum += 0.25F * counts.at<float>(other);
          }
          smooth.at<float>(at) = sum;
        }
      }
    }
    counts = smooth;
  }
  histogram_ = counts / (total * kBinWidth * kBinWidth * kBinWidth);
}

cv::Mat ObjectColours::log_likelihood(const cv::Mat& picture) const {
  constexpr float kKnown = 0.8F;  // the rest: colours that the sure part does not show
  if (histogram_.empty()) return cv::Mat(picture.size(), CV_32F, cv::Scalar(std::log(kAnyColour)));
  cv::Mat result(picture.size(), CV_32F);
  for (int y = 0; y < picture.rows; ++y) {
    const auto* p = picture.ptr<cv::Vec3f>(y);
    for (int x = 0; x < picture.cols; ++x) {
      int bin[3];
      for (int c = 0; c < 3; ++c) bin[c] = std::clamp(cvFloor(p[x][c] / kBinWidth), 0, kBins - 1);
      result.at<float>(y, x) =
          std::log(kKnown * histogram_.at<float>(bin) + (1 - kKnown) * kAnyColour);
    }
  }
  return result;
}

}  // namespace posevote
