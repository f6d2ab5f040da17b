#include "posevote/teach/photometry.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace posevote {
namespace {

constexpr double kFrameShare = 0.08;  // the frame that is expected to show background only
constexpr double kTukey = 4.685;      // 95 % efficiency for normal residuals
constexpr double kMadToSigma = 1.4826;
constexpr double kMinSigma = 0.5;   // rounding to whole levels alone gives 0.29 * sqrt(2)
constexpr double kMaxShift = 0.02;  // of the longer side: more is a moved camera, not a jitter

double median_of(std::vector<float>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The most frequent log ratio picture / background in the frame: unlike the median it stands when
// the object or its shadow reach over much of the frame.
double mode_of_gain(const cv::Mat& picture, const cv::Mat& background, const cv::Mat& frame,
                    int channel) {
  constexpr int kBins = 240;
  constexpr double kWidth = 0.02;
  constexpr float kDark = 4;  // levels; keeps the ratio of black pixels finite
  cv::Mat histogram = cv::Mat::zeros(1, kBins, CV_32F);
  for (int y = 0; y < picture.rows; ++y) {
    const auto* p = picture.ptr<cv::Vec3f>(y);
    const auto* b = background.ptr<cv::Vec3f>(y);
    const auto* f = frame.ptr<uchar>(y);
    for (int x = 0; x < picture.cols; ++x) {
      if (!f[x] || p[x][channel] > 250 || b[x][channel] > 250) continue;
      const double ratio = std::log((p[x][channel] + kDark) / (b[x][channel] + kDark));
      const int bin = static_cast<int>(std::floor(ratio / kWidth + kBins / 2.0));
      if (bin >= 0 && bin < kBins) histogram.at<float>(bin) += 1;
    }
  }
  cv::GaussianBlur(histogram, histogram, cv::Size(0, 0), 3, 1);
  cv::Point peak;
  double height = 0;
  cv::minMaxLoc(histogram, nullptr, &height, nullptr, &peak);
  return height > 0 ? std::exp((peak.x + 0.5 - kBins / 2.0) * kWidth) : 1.0;
}

// Every step-th pixel in x and y makes about 12,000 samples: more would not be more accurate.
int sampling_step(cv::Size size) {
  return std::max(1, static_cast<int>(std::sqrt(size.area() / 12000.0)));
}

struct Line {
  double gain, offset, sigma;
};

// Gain and offset of one channel. A background of one brightness cannot tell the two apart, so
// both are drawn to (start, 0) as strongly as 1 % of the samples would.
Line fit_line(const cv::Mat& picture, const cv::Mat& background, const cv::Mat& frame, int channel,
              double start) {
  std::vector<cv::Point2f> samples;
  std::vector<float> residuals;
  const int step = sampling_step(picture.size());
  for (int y = 0; y < picture.rows; y += step) {
    for (int x = 0; x < picture.cols; x += step) {
      const float p = picture.at<cv::Vec3f>(y, x)[channel];
      const float b = background.at<cv::Vec3f>(y, x)[channel];
      if (p > 250 || b > 250) continue;  // clipped: says nothing of the gain
      samples.emplace_back(b, p);
      if (frame.at<uchar>(y, x)) residuals.push_back(static_cast<float>(std::abs(p - start * b)));
    }
  }
  Line line{start, 0, std::max(kMinSigma, kMadToSigma * median_of(residuals))};
  for (int iteration = 0; iteration < 8; ++iteration) {
    double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
    residuals.clear();
    for (const auto& [x, y] : samples) {
      const double r = (y - line.gain * x - line.offset) / (kTukey * line.sigma);
      if (std::abs(r) >= 1) continue;
      const double k = (1 - r * r) * (1 - r * r);
      w += k, wx += k * x, wy += k * y, wxx += k * x * x, wxy += k * x * y;
      residuals.push_back(static_cast<float>(std::abs(r)));
    }
    if (w < 10) break;
    const double hold_offset = 0.01 * w, hold_gain = 0.01 * w;
    const double a11 = wxx + hold_gain, a22 = w + hold_offset;
    const double b1 = wxy + hold_gain * start;
    const double det = a11 * a22 - wx * wx;
    if (det <= 0) break;
    line.gain = (b1 * a22 - wx * wy) / det;
    line.offset = (a11 * wy - wx * b1) / det;
    const double spread = kMadToSigma * median_of(residuals) * kTukey * line.sigma;
    line.sigma = std::max(kMinSigma, std::min(line.sigma, spread));
  }
  return line;
}

void apply_gain(const cv::Mat& background, BackgroundFit& fit) {
  cv::multiply(background, cv::Scalar(fit.gain[0], fit.gain[1], fit.gain[2]), fit.expected);
  cv::add(fit.expected, cv::Scalar(fit.offset[0], fit.offset[1], fit.offset[2]), fit.expected);
  cv::min(cv::max(fit.expected, 0), 255, fit.expected);
}

void compensate(const cv::Mat& picture, const cv::Mat& background, BackgroundFit& fit) {
  cv::Mat p, b;
  cv::GaussianBlur(picture, p, cv::Size(5, 5), 1);
  cv::GaussianBlur(background, b, cv::Size(5, 5), 1);
  const cv::Mat frame = border_frame(picture.size(), kFrameShare);
  for (int c = 0; c < 3; ++c) {
    const auto i = static_cast<std::size_t>(c);
    const Line line = fit_line(p, b, frame, c, mode_of_gain(p, b, frame, c));
    fit.gain[i] = line.gain;
    fit.offset[i] = line.offset;
  }
  apply_gain(background, fit);
}

cv::Mat grey_of(const cv::Mat& bgr) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

// One robust Gauss-Newton step of the shift that brings `expected` onto `picture` (Lucas-Kanade for
// the whole picture). Zero when the background has too little structure to tell.
cv::Point2d shift_step(const cv::Mat& picture, const cv::Mat& expected) {
  cv::Mat dx, dy;
  cv::Sobel(expected, dx, CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(expected, dy, CV_32F, 0, 1, 3, 1.0 / 8);
  const cv::Mat difference = picture - expected;
  std::vector<float> absolute;
  for (int y = 0; y < difference.rows; y += 3) {
    for (int x = 0; x < difference.cols; x += 3) {
      absolute.push_back(std::abs(difference.at<float>(y, x)));
    }
  }
  const double sigma = std::max(kMinSigma, kMadToSigma * median_of(absolute));
  double xx = 0, xy = 0, yy = 0, xd = 0, yd = 0;
  for (int y = 0; y < difference.rows; ++y) {
    for (int x = 0; x < difference.cols; ++x) {
      const double d = difference.at<float>(y, x);
      const double r = d / (kTukey * sigma);
      if (std::abs(r) >= 1) continue;
      const double k = (1 - r * r) * (1 - r * r);
      const double gx = dx.at<float>(y, x), gy = dy.at<float>(y, x);
      xx += k * gx * gx, xy += k * gx * gy, yy += k * gy * gy;
      xd += k * gx * d, yd += k * gy * d;
    }
  }
  // The smaller eigenvalue bounds the shift's variance: sigma^2 / lambda.
  const double lambda = (xx + yy) / 2 - std::sqrt((xx - yy) * (xx - yy) / 4 + xy * xy);
  constexpr double kWantedAccuracy = 0.02;  // px
  if (lambda <= sigma * sigma / (kWantedAccuracy * kWantedAccuracy)) return {};
  const double det = xx * yy - xy * xy;
  return {-(xd * yy - yd * xy) / det, -(yd * xx - xd * xy) / det};
}

cv::Mat shifted(const cv::Mat& image, cv::Point2d by) {
  const cv::Matx23d warp(1, 0, by.x, 0, 1, by.y);
  cv::Mat result;
  cv::warpAffine(image, result, warp, image.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return result;
}

double frame_residual(const cv::Mat& picture, const cv::Mat& expected) {
  cv::Mat difference;
  cv::absdiff(picture, expected, difference);
  const cv::Mat frame = border_frame(picture.size(), 2 * kFrameShare);
  std::vector<float> values;
  for (int y = 0; y < frame.rows; ++y) {
    for (int x = 0; x < frame.cols; ++x) {
      if (frame.at<uchar>(y, x)) values.push_back(difference.at<float>(y, x));
    }
  }
  return median_of(values);
}

// Coarse to fine; kept only when it makes the frame agree better.
cv::Point2d estimate_shift(const cv::Mat& picture, const cv::Mat& expected) {
  const cv::Mat p = grey_of(picture), e = grey_of(expected);
  cv::Point2d shift;
  for (const int level : {2, 1, 0}) {
    const int scale = 1 << level;
    if (std::min(p.rows, p.cols) < 24 * scale) continue;
    cv::Mat small_p = p, small_e = e;
    for (int i = 0; i < level; ++i) {
      cv::pyrDown(small_p, small_p);
      cv::pyrDown(small_e, small_e);
    }
    cv::GaussianBlur(small_p, small_p, cv::Size(5, 5), 1);
    cv::GaussianBlur(small_e, small_e, cv::Size(5, 5), 1);
    for (int iteration = 0; iteration < 3; ++iteration) {
      const cv::Point2d step = shift_step(small_p, shifted(small_e, shift / scale)) * scale;
      shift += step;
      if (std::hypot(step.x, step.y) < 0.02) break;
    }
  }
  const double limit = kMaxShift * std::max(p.rows, p.cols);
  constexpr double kNegligible = 0.05;  // px
  const double length = std::hypot(shift.x, shift.y);
  if (!(length > kNegligible && length < limit)) return {};
  return frame_residual(p, shifted(e, shift)) < frame_residual(p, e) ? shift : cv::Point2d();
}

// What looks unchanged: the residual is small over a whole neighbourhood.
cv::Mat unchanged_pixels(const cv::Mat& residual, const cv::Mat& frame) {
  cv::Mat magnitude, channels[3];
  cv::split(cv::abs(residual), channels);
  magnitude = (channels[0] + channels[1] + channels[2]) / 3;
  cv::boxFilter(magnitude, magnitude, -1, cv::Size(7, 7));
  std::vector<float> values;
  for (int y = 0; y < frame.rows; ++y) {
    for (int x = 0; x < frame.cols; ++x) {
      if (frame.at<uchar>(y, x)) values.push_back(magnitude.at<float>(y, x));
    }
  }
  // Mean |r| over a window varies little where nothing changed: twice the median is an outlier.
  return magnitude <= std::max(1.0, 2 * median_of(values));
}

cv::Mat gradient_energy(const cv::Mat& image) {
  cv::Mat dx, dy;
  cv::Sobel(image, dx, CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(image, dy, CV_32F, 0, 1, 3, 1.0 / 8);
  return dx.mul(dx) + dy.mul(dy);
}

// Empty levels take the nearest measured one, for want of better.
void fill_levels(std::array<float, NoiseModel::kLevels>& sigma) {
  std::array<float, NoiseModel::kLevels> filled = sigma;
  for (int i = 0; i < NoiseModel::kLevels; ++i) {
    for (int away = 0; away < NoiseModel::kLevels && filled[i] == 0; ++away) {
      const float below = i - away >= 0 ? sigma[i - away] : 0;
      const float above = i + away < NoiseModel::kLevels ? sigma[i + away] : 0;
      filled[i] = std::max(below, above);
    }
    if (filled[i] == 0) filled[i] = 2;  // nothing measured at all: a common camera's noise
  }
  sigma = filled;
}

NoiseModel measure_noise(const cv::Mat& picture, const cv::Mat& expected) {
  const cv::Mat residual = picture - expected;
  const cv::Mat usable = unchanged_pixels(residual, border_frame(picture.size(), kFrameShare));
  const cv::Mat energy = gradient_energy(expected);
  NoiseModel noise;
  std::vector<float> excess;
  constexpr std::size_t kEnough = 60;
  const int step = sampling_step(picture.size());
  for (int c = 0; c < 3; ++c) {
    std::array<std::vector<float>, NoiseModel::kLevels> flat;
    const auto for_usable = [&](auto&& visit) {
      for (int y = 0; y < picture.rows; y += step) {
        for (int x = 0; x < picture.cols; x += step) {
          if (!usable.at<uchar>(y, x)) continue;
          const float level = expected.at<cv::Vec3f>(y, x)[c];
          visit(static_cast<std::size_t>(std::clamp(cvRound(level / 16), 0, 16)),
                std::abs(residual.at<cv::Vec3f>(y, x)[c]), energy.at<cv::Vec3f>(y, x)[c]);
        }
      }
    };
    for_usable([&](std::size_t level, float r, float e) {
      if (e < 4) flat[level].push_back(r);  // less than 2 levels per px
    });
    auto& sigma = noise.sigma[static_cast<std::size_t>(c)];
    for (std::size_t i = 0; i < flat.size(); ++i) {
      if (flat[i].size() < kEnough) continue;
      // The mean of |r| up to 3 MAD: the median of whole-numbered residuals is too coarse.
      std::vector<float> copy = flat[i];
      const double cut = std::max(1.0, 3 * kMadToSigma * median_of(copy));
      double sum = 0, count = 0;
      for (const float r : flat[i]) {
        if (r <= cut) sum += r, count += 1;
      }
      sigma[i] = static_cast<float>(std::max(kMinSigma, 1.2533 * sum / count));
    }
    fill_levels(sigma);
    for_usable([&](std::size_t level, float r, float e) {
      // E r^2 = sigma^2 + jitter^2 * energy; the median of r^2 is 0.455 of its mean.
      if (e > 36) excess.push_back((r * r / 0.455F - sigma[level] * sigma[level]) / e);
    });
  }
  if (excess.size() >= kEnough) {
    noise.jitter_px = static_cast<float>(std::sqrt(std::max(0.0, median_of(excess))));
  }
  return noise;
}

cv::Mat fine_structure(const cv::Mat& grey) {
  cv::Mat smooth, fine;
  cv::GaussianBlur(grey, smooth, cv::Size(0, 0), 5);
  cv::GaussianBlur(grey - smooth, fine, cv::Size(0, 0), 1.5);
  return fine;
}

// In blocks, because the object may reach into some, and a shadow scales but keeps the structure.
double texture_agreement(const cv::Mat& picture, const BackgroundFit& fit) {
  constexpr int kBlock = 24;
  constexpr double kStructure =
      3;  // levels; noise that is so strong after smoothing blinds a camera
  constexpr std::size_t kMinBlocks = 8;
  const cv::Mat p = fine_structure(grey_of(picture)), e = fine_structure(grey_of(fit.expected));
  std::vector<float> correlations;
  for (int y = 0; y + kBlock <= p.rows; y += kBlock) {
    for (int x = 0; x + kBlock <= p.cols; x += kBlock) {
      const bool inner = y > 0 && x > 0 && y + 2 * kBlock <= p.rows && x + 2 * kBlock <= p.cols;
      if (inner) continue;
      const cv::Rect block(x, y, kBlock, kBlock);
      const double pp = cv::norm(p(block)), ee = cv::norm(e(block));
      if (ee < kStructure * kBlock || pp == 0) continue;
      correlations.push_back(static_cast<float>(p(block).dot(e(block)) / (pp * ee)));
    }
  }
  return correlations.size() < kMinBlocks ? 1 : median_of(correlations);
}

}  // namespace

cv::Mat border_frame(cv::Size size, double share) {
  const int width = std::max(1, cvRound(share * std::min(size.width, size.height)));
  cv::Mat frame(size, CV_8U, cv::Scalar(255));
  const cv::Rect inner(width, width, size.width - 2 * width, size.height - 2 * width);
  if (inner.width > 0 && inner.height > 0) frame(inner) = 0;
  return frame;
}

cv::Mat NoiseModel::variance(const cv::Mat& expected) const {
  cv::Mat result = gradient_energy(expected) * (jitter_px * jitter_px);
  for (int y = 0; y < expected.rows; ++y) {
    const auto* e = expected.ptr<cv::Vec3f>(y);
    auto* v = result.ptr<cv::Vec3f>(y);
    for (int x = 0; x < expected.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        const float position = std::clamp(e[x][c], 0.F, 255.F) / 16;
        const auto i = static_cast<std::size_t>(position);
        const float t = position - static_cast<float>(i);
        const auto& s = sigma[static_cast<std::size_t>(c)];
        const float value = (1 - t) * s[i] + t * s[i + 1];
        v[x][c] += value * value;
      }
    }
  }
  return result;
}

BackgroundFit fit_background(const cv::Mat& picture, const cv::Mat& background) {
  BackgroundFit fit;
  compensate(picture, background, fit);
  fit.shift = estimate_shift(picture, fit.expected);
  if (fit.shift != cv::Point2d()) compensate(picture, shifted(background, fit.shift), fit);
  fit.noise = measure_noise(picture, fit.expected);
  fit.texture_agreement = texture_agreement(picture, fit);
  return fit;
}

BackgroundFit transfer_fit(const BackgroundFit& fit, double scale, const cv::Mat& picture,
                           const cv::Mat& background) {
  BackgroundFit result = fit;
  result.shift = fit.shift * scale;
  const bool moved = fit.shift != cv::Point2d();
  apply_gain(moved ? shifted(background, result.shift) : background, result);
  result.noise = measure_noise(picture, result.expected);
  return result;
}

}  // namespace posevote
