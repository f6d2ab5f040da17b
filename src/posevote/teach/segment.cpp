#include "posevote/teach/segment.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"
#include "posevote/teach/graph_cut.hpp"
#include "posevote/teach/photometry.hpp"

namespace posevote {
namespace {

void check_type(const cv::Mat& picture) {
  if (picture.empty()) throw Error(ErrorCode::invalid_argument, "the picture is empty");
  const int channels = picture.channels();
  if (picture.dims != 2 || (picture.depth() != CV_8U && picture.depth() != CV_16U) ||
      (channels != 1 && channels != 3 && channels != 4)) {
    throw Error(ErrorCode::invalid_argument,
                "a picture must have 8 or 16 bits and 1, 3 or 4 channels, not the type " +
                    cv::typeToString(picture.type()));
  }
}

void refuse_moved_camera(const BackgroundFit& fit) {
  // Unmoved, structure well above the noise correlates by 0.9 and more; strange ones by about 0.
  constexpr double kSameScene = 0.5;
  if (fit.texture_agreement < kSameScene) {
    throw Error(ErrorCode::unusable_view,
                "the surroundings in the picture and in the background picture do not agree; the "
                "camera has moved or the two do not belong together: fix the camera and take both "
                "again");
  }
}

// A camera's exposure and white balance drift by less; more is an object that fills the picture, or
// another light.
void refuse_other_light(const BackgroundFit& fit) {
  constexpr double kExposure = 3, kWhiteBalance = 1.8;
  const auto [low, high] = std::minmax_element(fit.gain.begin(), fit.gain.end());
  if (*low < 1 / kExposure || *high > kExposure || *high > kWhiteBalance * *low) {
    throw Error(
        ErrorCode::unusable_view,
        "the border of the picture has another brightness or colour than the background "
        "picture; leave free background around the object, lock exposure and white balance, "
        "and keep the light as it is");
  }
}

void refuse_bad_mask(const cv::Mat& mask, const SegmentOptions& options) {
  const double coverage = cv::countNonZero(mask) / static_cast<double>(mask.total());
  const auto refuse = [](const std::string& why) { throw Error(ErrorCode::unusable_view, why); };
  if (coverage == 0 || coverage < options.min_coverage) {
    refuse(
        "nothing in the picture differs from the background picture; check that the object is "
        "in it and large enough, and that the two pictures are not the same");
  }
  if (coverage > options.max_coverage) {
    refuse(
        "nearly the whole picture differs from the background picture; fix the camera, lock "
        "exposure and white balance, or move the camera back from the object");
  }
  const cv::Rect box = cv::boundingRect(mask);
  if (box.size() == mask.size()) {
    refuse(
        "what differs from the background picture reaches all four sides of the picture; move "
        "the camera back, fix it, and keep hands and other moving things out of the picture");
  }
}

// CV_32FC3 in 8-bit levels, lightly smoothed: half of the noise goes, a border moves by less than
// half a pixel.
cv::Mat working_copy(const cv::Mat& picture, cv::Size size) {
  cv::Mat bgr;
  const double unit = picture.depth() == CV_16U ? 1.0 / 256 : 1.0;
  if (picture.channels() == 1)
    cv::cvtColor(picture, bgr, cv::COLOR_GRAY2BGR);
  else if (picture.channels() == 4)
    cv::cvtColor(picture, bgr, cv::COLOR_BGRA2BGR);
  else
    bgr = picture;
  cv::Mat result;
  bgr.convertTo(result, CV_32FC3, unit);
  if (size != picture.size()) cv::resize(result, result, size, 0, 0, cv::INTER_AREA);
  cv::GaussianBlur(result, result, cv::Size(0, 0), 0.7);
  return result;
}

// What separates two neighbours beyond the background's own texture: a step in brightness or
// colour, measured against the range around: an object's border is as sharp as the camera sees, a
// shadow's is a ramp.
struct Novelty {
  cv::Mat rest;    // CV_32FC3: picture - shading * expected
  cv::Mat unit;    // CV_32FC3: direction of the background's colour
  cv::Mat noise;   // CV_32F: standard deviation of one channel
  cv::Mat along;   // CV_32F: range of brightness in the neighbourhood
  cv::Mat across;  // CV_32F: range of colour in the neighbourhood
};

// Largest minus smallest value in a window, the largest over the channels.
cv::Mat local_range(const cv::Mat& image) {
  const cv::Mat window = cv::getStructuringElement(cv::MORPH_RECT, {9, 9});
  cv::Mat low, high;
  cv::dilate(image, high, window);
  cv::erode(image, low, window);
  cv::Mat range = high - low;
  if (range.channels() == 1) return range;
  std::vector<cv::Mat> planes;
  cv::split(range, planes);
  return cv::max(cv::max(planes[0], planes[1]), planes[2]);
}

Novelty novelty_of(const cv::Mat& picture, const cv::Mat& expected, const cv::Mat& shading,
                   const cv::Mat& variance) {
  Novelty n;
  n.rest = picture.clone();
  n.unit.create(picture.size(), CV_32FC3);
  n.noise.create(picture.size(), CV_32F);
  cv::Mat brightness(picture.size(), CV_32F), colour(picture.size(), CV_32FC3);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const auto& p = picture.at<cv::Vec3f>(y, x);
      const auto& b = expected.at<cv::Vec3f>(y, x);
      const auto& v = variance.at<cv::Vec3f>(y, x);
      const float length = std::sqrt(b.dot(b));
      const cv::Vec3f unit = length > 1 ? cv::Vec3f(b / length) : cv::Vec3f::all(0.57735F);
      n.rest.at<cv::Vec3f>(y, x) -= shading.at<float>(y, x) * b;
      n.unit.at<cv::Vec3f>(y, x) = unit;
      n.noise.at<float>(y, x) = std::sqrt((v[0] + v[1] + v[2]) / 3);
      brightness.at<float>(y, x) = (p - b).dot(unit);
      colour.at<cv::Vec3f>(y, x) = p - p.dot(unit) * unit;
    }
  }
  n.along = local_range(brightness);
  n.across = local_range(colour);
  return n;
}

float edge_weight(const Novelty& n, cv::Point p, cv::Point q, double smoothness) {
  constexpr float kSharp = 0.12F;  // share of the range within one pixel
  const cv::Vec3f step = n.rest.at<cv::Vec3f>(p) - n.rest.at<cv::Vec3f>(q);
  const float along = step.dot(n.unit.at<cv::Vec3f>(p));
  const float across2 = std::max(0.F, step.dot(step) - along * along);
  const float noise = n.noise.at<float>(p);
  const float along_scale = 2 * noise + kSharp * n.along.at<float>(p);
  const float across_scale = 2 * noise + kSharp * n.across.at<float>(p);
  const float d2 =
      along * along / (along_scale * along_scale) + across2 / (across_scale * across_scale);
  return static_cast<float>(smoothness) * (0.02F + 0.98F * std::exp(-0.5F * d2));
}

GridEdges grid_edges(const Novelty& novelty, double smoothness) {
  const cv::Size size = novelty.rest.size();
  const auto weights = [&](cv::Point to, float distance) {
    cv::Mat result(size, CV_32F, cv::Scalar(0));
    for (int y = 0; y + to.y < size.height; ++y) {
      for (int x = std::max(0, -to.x); x + std::max(0, to.x) < size.width; ++x) {
        const cv::Point p(x, y);
        result.at<float>(p) = edge_weight(novelty, p, p + to, smoothness) / distance;
      }
    }
    return result;
  };
  const float diagonal = std::sqrt(2.F);
  return {weights({1, 0}, 1), weights({0, 1}, 1), weights({1, 1}, diagonal),
          weights({-1, 1}, diagonal)};
}

// Pixels worth deciding: all near some that speak for the object.
cv::Mat open_pixels(const cv::Mat& log_odds) {
  cv::Mat smooth, open;
  cv::boxFilter(log_odds, smooth, -1, cv::Size(3, 3));
  open = smooth > -0.2;
  cv::dilate(open, open, cv::getStructuringElement(cv::MORPH_RECT, {11, 11}));
  return open;
}

// Fills what is enclosed, unless the background itself is plainly seen through it (a handle): its
// exact brightness or its texture, which a plain or shaded patch of the object would not show.
void fill_holes(cv::Mat& mask, const cv::Mat& log_odds) {
  constexpr double kSeen = -0.2;  // mean log odds per pixel
  constexpr int kMinArea = 16;
  cv::Mat labels, stats, centroids;
  cv::Mat background;
  cv::copyMakeBorder(255 - mask, background, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  const int count =
      cv::connectedComponentsWithStats(background, labels, stats, centroids, 4, CV_32S);
  const int outside = labels.at<int>(0, 0);
  labels = labels(cv::Rect(1, 1, mask.cols, mask.rows));
  std::vector<double> sum(static_cast<std::size_t>(count), 0);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      sum[static_cast<std::size_t>(labels.at<int>(y, x))] += log_odds.at<float>(y, x);
    }
  }
  for (int i = 1; i < count; ++i) {
    if (i == outside) continue;
    const int area = stats.at<int>(i, cv::CC_STAT_AREA);
    if (area < kMinArea || sum[static_cast<std::size_t>(i)] > kSeen * area)
      mask.setTo(255, labels == i);
  }
}

// The largest part and those not much smaller; parts cut by the border only if they are the
// largest: they are things beside the scene that have moved.
cv::Mat choose_parts(const cv::Mat& mask, double part_share) {
  cv::Mat labels, stats, centroids;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centroids, 8, CV_32S);
  int largest = 0;
  for (int i = 1; i < count; ++i) {
    if (largest == 0 ||
        stats.at<int>(i, cv::CC_STAT_AREA) > stats.at<int>(largest, cv::CC_STAT_AREA))
      largest = i;
  }
  cv::Mat chosen = cv::Mat::zeros(mask.size(), CV_8U);
  if (largest == 0) return chosen;
  const double enough = part_share * stats.at<int>(largest, cv::CC_STAT_AREA);
  for (int i = 1; i < count; ++i) {
    const cv::Rect box(stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                       stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT));
    const bool cut = box.x == 0 || box.y == 0 || box.br().x == mask.cols || box.br().y == mask.rows;
    if (i == largest || (!cut && stats.at<int>(i, cv::CC_STAT_AREA) >= enough))
      chosen.setTo(255, labels == i);
  }
  return chosen;
}

float log_add(float a, float b) {
  const float high = std::max(a, b);
  return high + std::log1p(std::exp(std::min(a, b) - high));
}

// In [-1, 1]: is the mean over a window another than the background's? Plain patches can be told
// from the lit background by this alone. Less is said by a patch that is darker than a background
// that is dark itself: nearly every shadow is, between black and there is little else to be.
cv::Mat change_map(const cv::Mat& picture, const cv::Mat& expected, const cv::Mat& variance) {
  constexpr int kWindow = 5;
  constexpr float kMeanNoise =
      0.4F;                     // of the mean, in units of one pixel's: they are not independent
  constexpr float kDoubt2 = 9;  // three standard deviations are as likely as not a change
  constexpr float kDark = 16, kGrey = 128;  // levels
  cv::Mat mean;
  cv::boxFilter(picture - expected, mean, CV_32F, {kWindow, kWindow});
  cv::Mat result(picture.size(), CV_32F);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const auto& m = mean.at<cv::Vec3f>(y, x);
      const auto& v = variance.at<cv::Vec3f>(y, x);
      const auto& b = expected.at<cv::Vec3f>(y, x);
      float z2 = 0;
      for (int c = 0; c < 3; ++c) z2 += m[c] * m[c] / (kMeanNoise * kMeanNoise * v[c]);
      float change = (z2 - kDoubt2) / (z2 + kDoubt2);
      if (change > 0 && m[0] + m[1] + m[2] < 0) {
        const float level = std::max(1.F, (b[0] + b[1] + b[2]) / 3);
        change *= std::clamp(std::log(level / kDark) / std::log(kGrey / kDark), 0.F, 1.F);
      }
      result.at<float>(y, x) = change;
    }
  }
  return result;
}

cv::Mat object_log_odds(const cv::Mat& picture, const cv::Mat& expected, const cv::Mat& variance,
                        const cv::Mat& background, const ObjectColours& colours,
                        const SegmentOptions& options) {
  const cv::Mat coloured = colours.log_likelihood(picture);
  const cv::Mat plain = plain_log_likelihood(picture, variance, options.shadow);
  const cv::Mat change = change_map(picture, expected, variance);
  cv::Mat log_odds(picture.size(), CV_32F);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const float object =
          log_add(coloured.at<float>(y, x), plain.at<float>(y, x)) + std::log(0.5F);
      const float odds = object - background.at<float>(y, x);
      log_odds.at<float>(y, x) =
          static_cast<float>(options.evidence * odds + options.bias * change.at<float>(y, x));
    }
  }
  return log_odds;
}

// One size of the two pictures and what is derived from them.
struct Level {
  cv::Mat picture;
  BackgroundFit fit;
  cv::Mat variance;
};

Level make_coarse(const cv::Mat& picture, const cv::Mat& background, cv::Size size) {
  Level level;
  level.picture = working_copy(picture, size);
  level.fit = fit_background(level.picture, working_copy(background, size));
  level.variance = level.fit.noise.variance(level.fit.expected);
  return level;
}

// Only the part of it that holds `area`, in pixels of the new size.
Level make_fine(const cv::Mat& picture, const cv::Mat& background, cv::Size size,
                const Level& coarse, const cv::Rect& area) {
  Level level;
  level.picture = working_copy(picture, size);
  const double scale = size.width / static_cast<double>(coarse.picture.cols);
  level.fit = transfer_fit(coarse.fit, scale, level.picture, working_copy(background, size));
  level.picture = level.picture(area);
  level.fit.expected = level.fit.expected(area);
  level.variance = level.fit.noise.variance(level.fit.expected);
  return level;
}

// What reaches the picture's border pays for it as for any border without an edge: the object is
// meant to be inside, a shadow need not be.
void expect_inside(cv::Mat& log_odds, double smoothness) {
  const int right = log_odds.cols - 1, bottom = log_odds.rows - 1;
  for (cv::Mat side :
       {log_odds.row(0), log_odds.row(bottom), log_odds.col(0), log_odds.col(right)}) {
    side -= smoothness;
  }
}

// Shading and colours are learned from `mask`, the best labelling so far; the new one differs from
// it only where `open` is set.
cv::Mat improve(const Level& level, const cv::Mat& mask, const cv::Mat& open,
                const SegmentOptions& options) {
  const auto& [picture, fit, variance] = level;
  cv::Mat sure, weight;
  cv::erode(mask, sure, cv::getStructuringElement(cv::MORPH_ELLIPSE, {5, 5}));
  cv::Mat(255 - mask).convertTo(weight, CV_32F, 1.0 / 255);
  const cv::Mat shading = estimate_shading(picture, fit.expected, variance, weight, options.shadow);
  const cv::Mat background =
      background_log_likelihood(picture, fit.expected, variance, shading, options.shadow);
  cv::Mat log_odds = object_log_odds(picture, fit.expected, variance, background,
                                     ObjectColours(picture, sure), options);
  const Novelty novelty = novelty_of(picture, fit.expected, shading, variance);
  if (open.empty()) expect_inside(log_odds, options.smoothness);
  const cv::Mat decided = open.empty() ? open_pixels(log_odds) : open;
  const cv::Mat given = open.empty() ? cv::Mat::zeros(mask.size(), CV_8U) : mask;
  cv::Mat result = cut_grid(log_odds, grid_edges(novelty, options.smoothness), decided, given);
  fill_holes(result, log_odds);
  return result;
}

cv::Mat resized_mask(const cv::Mat& mask, cv::Size size) {
  if (size == mask.size()) return mask;
  cv::Mat result;
  cv::resize(mask, result, size, 0, 0, cv::INTER_LINEAR);
  return result > 127;
}

cv::Mat band_around_border(const cv::Mat& mask, int radius) {
  cv::Mat high, low;
  const cv::Mat disc =
      cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1});
  cv::dilate(mask, high, disc);
  cv::erode(mask, low, disc, cv::Point(-1, -1), 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  return high - low;
}

cv::Size size_for(cv::Size size, int pixels) {
  const double scale = std::min(1.0, std::sqrt(pixels / static_cast<double>(size.area())));
  return {std::max(1, cvRound(size.width * scale)), std::max(1, cvRound(size.height * scale))};
}

// The border again, in a larger copy.
cv::Mat refine(const cv::Mat& picture, const cv::Mat& background, const Level& coarse,
               const cv::Mat& coarse_mask, const SegmentOptions& options) {
  const cv::Size size = size_for(picture.size(), options.working_pixels);
  if (size == coarse_mask.size() || cv::countNonZero(coarse_mask) == 0) return coarse_mask;
  cv::Mat mask = resized_mask(coarse_mask, size);
  const double scale = size.width / static_cast<double>(coarse_mask.cols);
  cv::Rect area = cv::boundingRect(mask);
  const int margin = cvCeil(8 * scale);
  area = cv::Rect(area.x - margin, area.y - margin, area.width + 2 * margin,
                  area.height + 2 * margin) &
         cv::Rect(cv::Point(), size);
  const Level fine = make_fine(picture, background, size, coarse, area);
  const cv::Mat part = mask(area);
  improve(fine, part, band_around_border(part, cvCeil(2 * scale)), options).copyTo(part);
  return choose_parts(mask, options.part_share);
}

}  // namespace

void SegmentOptions::describe(OptionList& list) {
  list.group("shadow", shadow);
  list.add("coarse_pixels", coarse_pixels, {1000, 100'000'000}, "",
           "Most pixels of the copy that the object is found in.");
  list.add("working_pixels", working_pixels, {1000, 100'000'000}, "",
           "Most pixels of the copy that the object's border is found in.");
  list.add("rounds", rounds, {1, 20}, "", "Times that shadow and colours are learned.");
  list.add("evidence", evidence, {0, 1}, "", "Weight of a pixel's colour against its borders.");
  list.add("bias", bias, {-10, 10}, "nats", "For the object where a pixel could be either.");
  list.add("smoothness", smoothness, {0, 1000}, "nats", "Cost of a border where no edge is seen.");
  list.add("max_coverage", max_coverage, {0, 1}, "", "An object that covers more is refused.");
  list.add("min_coverage", min_coverage, {0, 1}, "", "What covers less is taken for nothing.");
  list.add("part_share", part_share, {0, 1}, "",
           "Further parts count from this share of the largest.");
}

std::string size_text(const cv::Mat& picture) {
  return std::to_string(picture.cols) + " x " + std::to_string(picture.rows) + " px";
}

cv::Mat to_bgr8(const cv::Mat& picture) {
  check_type(picture);
  constexpr double kFloor = -0.498;  // not rounding: both v * 256 and v * 257 become v
  cv::Mat result = picture;
  if (picture.channels() == 1) cv::cvtColor(picture, result, cv::COLOR_GRAY2BGR);
  if (picture.channels() == 4) cv::cvtColor(picture, result, cv::COLOR_BGRA2BGR);
  if (result.depth() == CV_16U) result.convertTo(result, CV_8U, 1.0 / 256, kFloor);
  return result.data == picture.data ? picture.clone() : result;
}

cv::Mat segment_by_background(const cv::Mat& picture, const cv::Mat& background,
                              const SegmentOptions& options) {
  check_type(picture);
  check_type(background);
  if (picture.size() != background.size()) {
    throw Error(ErrorCode::invalid_argument, "the background is " + size_text(background) +
                                                 " but the picture " + size_text(picture) +
                                                 "; take both with the same camera and settings");
  }
  const Level coarse =
      make_coarse(picture, background, size_for(picture.size(), options.coarse_pixels));
  refuse_moved_camera(coarse.fit);
  refuse_other_light(coarse.fit);
  cv::Mat mask = cv::Mat::zeros(coarse.picture.size(), CV_8U);
  for (int round = 0; round < options.rounds; ++round) {
    mask = improve(coarse, mask, cv::Mat(), options);
  }
  mask = choose_parts(mask, options.part_share);
  refuse_bad_mask(mask, options);
  mask = refine(picture, background, coarse, mask, options);
  return resized_mask(mask, picture.size());
}

}  // namespace posevote
