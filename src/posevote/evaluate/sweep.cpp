#include "posevote/evaluate/sweep.hpp"

#include <algorithm>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/summary.hpp"

namespace posevote {
namespace {

using Change = DisturbedPicture (*)(const cv::Mat&, double, const DatasetTest&, cv::RNG&);

DisturbedPicture add_noise(const cv::Mat& picture, double sigma, const DatasetTest&, cv::RNG& rng) {
  cv::Mat noise(picture.size(), CV_MAKETYPE(CV_32F, picture.channels()));
  rng.fill(noise, cv::RNG::NORMAL, 0, sigma);
  cv::Mat sum;
  cv::add(picture, noise, sum, cv::noArray(), CV_8U);
  return {sum};
}

DisturbedPicture blur(const cv::Mat& picture, double sigma, const DatasetTest&, cv::RNG&) {
  cv::Mat soft = picture;
  if (sigma > 0) cv::GaussianBlur(picture, soft, cv::Size(), sigma);
  return {soft};
}

DisturbedPicture compress(const cv::Mat& picture, double quality, const DatasetTest&, cv::RNG&) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, static_cast<int>(quality)});
  return {cv::imdecode(bytes, cv::IMREAD_UNCHANGED)};
}

DisturbedPicture ramp_light(const cv::Mat& picture, double loss, const DatasetTest&, cv::RNG&) {
  cv::Mat ramp(1, picture.cols, CV_32F);
  for (int x = 0; x < picture.cols; ++x)
    ramp.at<float>(x) = static_cast<float>(1 - loss * x / std::max(1, picture.cols - 1));
  cv::Mat gain, lit;
  cv::merge(std::vector<cv::Mat>(static_cast<std::size_t>(picture.channels()), ramp), gain);
  cv::multiply(picture, cv::repeat(gain, picture.rows, 1), lit, 1, CV_8U);
  return {lit};
}

DisturbedPicture rotate(const cv::Mat& picture, double degrees, const DatasetTest&, cv::RNG&) {
  const double angle = degrees * CV_PI / 180, c = std::cos(angle), s = std::sin(angle);
  const int width =
      static_cast<int>(std::lround(picture.cols * std::abs(c) + picture.rows * std::abs(s)));
  const int height =
      static_cast<int>(std::lround(picture.cols * std::abs(s) + picture.rows * std::abs(c)));
  const double x = (picture.cols - 1) / 2.0, y = (picture.rows - 1) / 2.0;
  DisturbedPicture result;
  result.from_original = {c, -s, (width - 1) / 2.0 - c * x + s * y,
                          s, c,  (height - 1) / 2.0 - s * x - c * y};
  cv::warpAffine(picture, result.picture, result.from_original, {width, height}, cv::INTER_LINEAR,
                 cv::BORDER_CONSTANT, cv::Scalar::all(127));
  return result;
}

DisturbedPicture scale(const cv::Mat& picture, double factor, const DatasetTest&, cv::RNG&) {
  const cv::Size size(std::max(1, static_cast<int>(std::lround(picture.cols * factor))),
                      std::max(1, static_cast<int>(std::lround(picture.rows * factor))));
  const double fx = static_cast<double>(size.width) / picture.cols;
  const double fy = static_cast<double>(size.height) / picture.rows;
  DisturbedPicture result;
  result.from_original = {fx, 0, (fx - 1) / 2, 0, fy, (fy - 1) / 2};
  cv::resize(picture, result.picture, size, 0, 0, factor < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  return result;
}

// The part of `box` that is hidden when `share` of it is covered from one of its four sides.
cv::Rect covered_part(const cv::Rect2d& box, double share, int side) {
  cv::Rect2d part = box;
  (side < 2 ? part.width : part.height) *= share;
  if (side == 1) part.x += box.width - part.width;
  if (side == 3) part.y += box.height - part.height;
  return {static_cast<int>(std::floor(part.x)), static_cast<int>(std::floor(part.y)),
          static_cast<int>(std::ceil(part.width)), static_cast<int>(std::ceil(part.height))};
}

DisturbedPicture occlude(const cv::Mat& picture, double per_cent, const DatasetTest& test,
                         cv::RNG& rng) {
  cv::Mat coarse(std::max(2, picture.rows / 16), std::max(2, picture.cols / 16), picture.type());
  rng.fill(coarse, cv::RNG::UNIFORM, 0, 256);
  cv::Mat pattern, covered = picture.clone();
  cv::resize(coarse, pattern, picture.size(), 0, 0, cv::INTER_CUBIC);
  for (const TruthObject& truth : test.objects) {
    const int side = rng.uniform(0, 4);
    const cv::Rect part =
        covered_part(truth.box, per_cent / 100, side) & cv::Rect(0, 0, picture.cols, picture.rows);
    if (per_cent > 0 && !part.empty()) pattern(part).copyTo(covered(part));
  }
  return {covered};
}

struct Sweep {
  Change change;
  SweepLevels levels;
};

const std::map<std::string, Sweep>& sweeps() {
  static const std::map<std::string, Sweep> all{
      {"noise", {add_noise, {"grey levels", {0, 5, 10, 20, 30, 40, 60}}}},
      {"blur", {blur, {"px", {0, 0.5, 1, 2, 3, 4, 6}}}},
      {"jpeg", {compress, {"quality", {95, 75, 50, 30, 20, 10, 5}}}},
      {"light", {ramp_light, {"loss to the right", {0, 0.2, 0.4, 0.6, 0.8, 0.9}}}},
      {"rotation", {rotate, {"deg", {0, 30, 60, 90, 120, 150, 180, 210, 240, 270, 300, 330, 360}}}},
      {"scale", {scale, {"times", {0.25, 0.35, 0.5, 0.71, 1, 1.41, 2, 2.83, 4}}}},
      {"occlusion", {occlude, {"% of the box", {0, 10, 20, 30, 40, 50, 60, 70, 80}}}}};
  return all;
}

const Sweep& find_sweep(const std::string& name) {
  const auto found = sweeps().find(name);
  if (found != sweeps().end()) return found->second;
  const std::string nearest = nearest_word(name, sweep_names());
  throw Error(ErrorCode::invalid_argument,
              "there is no sweep '" + name + "'" +
                  (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

cv::Mat to_8bit(const cv::Mat& picture) {
  if (picture.depth() != CV_16U) return picture;
  cv::Mat eight;
  picture.convertTo(eight, CV_8U, 1.0 / 256);
  return eight;
}

// The detections of a disturbed picture as they would lie in the original.
void take_back(RecognitionResult& result, const cv::Matx23d& from_original, cv::Size original) {
  cv::Mat inverse;
  cv::invertAffineTransform(from_original, inverse);
  for (Detection& detection : result.detections) {
    if (detection.outline.empty()) continue;
    cv::transform(detection.outline, detection.outline, inverse);
    float left = detection.outline[0].x, right = left, top = detection.outline[0].y, bottom = top;
    for (const cv::Point2f& point : detection.outline) {
      left = std::min(left, point.x);
      right = std::max(right, point.x);
      top = std::min(top, point.y);
      bottom = std::max(bottom, point.y);
    }
    detection.box = cv::Rect2d(left, top, right - left, bottom - top);
  }
  result.image_size = original;
}

TestOutcome run_one(const Dataset& dataset, std::size_t index, const std::string& sweep,
                    double level, const Recognizer& recognizer, std::uint64_t seed) {
  const DatasetTest& test = dataset.tests[index];
  const cv::Mat original = read_dataset_image(dataset, test.image);
  const DisturbedPicture disturbed = disturb(original, sweep, level, test, seed + index);
  TestOutcome outcome;
  outcome.test = index;
  outcome.result = recognizer.recognize(disturbed.picture);
  take_back(outcome.result, disturbed.from_original, original.size());
  outcome.score = score_detections(outcome.result, test, dataset);
  return outcome;
}

}  // namespace

const std::vector<std::string>& sweep_names() {
  static const std::vector<std::string> names{"noise",    "blur",  "jpeg",     "light",
                                              "rotation", "scale", "occlusion"};
  return names;
}

const SweepLevels& sweep_levels(const std::string& name) {
  return find_sweep(name).levels;
}

DisturbedPicture disturb(const cv::Mat& picture, const std::string& sweep, double level,
                         const DatasetTest& test, std::uint64_t seed) {
  cv::RNG rng(seed);
  return find_sweep(sweep).change(to_8bit(picture), level, test, rng);
}

ReportSection run_sweep(const std::string& sweep, const Dataset& dataset,
                        const TaughtMethod& taught, const Method& method, std::uint64_t seed) {
  const SweepLevels& range = sweep_levels(sweep);
  Dataset tests = dataset;
  std::erase_if(tests.tests, [](const DatasetTest& test) {
    return std::ranges::none_of(test.objects, &TruthObject::asked);
  });
  Table table;
  table.title = "Sweep: " + sweep;
  table.header = {
      sweep + " [" + range.unit + "]", "asked", "right", "recall", "false", "twins", "median ms"};
  ChartSeries recall{"recall", {}};
  for (const double level : range.levels) {
    std::vector<TestOutcome> outcomes(tests.tests.size());
    parallel_for(
        outcomes.size(), method.jobs,
        [&](std::size_t i) {
          outcomes[i] = run_one(tests, i, sweep, level, taught.recognizer(), seed);
        },
        task(method.progress, sweep + " " + fixed(level, 2)));
    const Summary s = summarize("", tests, outcomes);
    table.rows.push_back({fixed(level, 2), std::to_string(s.asked), std::to_string(s.right),
                          percent(s.recall()), std::to_string(s.false_positives),
                          std::to_string(s.twins), fixed(s.total.median_ms, 1)});
    recall.points.push_back({level, s.recall()});
  }
  return {"Robustness: " + sweep,
          "",
          {table},
          {{"Recall over " + sweep,
            {sweep + " [" + range.unit + "]", 0, 0},
            {"recall", 0, 1},
            {recall}}}};
}

}  // namespace posevote
