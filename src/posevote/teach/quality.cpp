#include "posevote/teach/quality.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "posevote/teach/repeatable.hpp"

namespace posevote {
namespace {

constexpr float kFar = std::numeric_limits<float>::max();

// Memory grows with the square of the number of features; the strongest stand for all.
constexpr int kMostFeatures = 3000;

Features strongest_of(const Features& features) {
  if (features.empty()) return {};
  const int count = std::min(kMostFeatures, static_cast<int>(features.size()));
  return {{features.keypoints.begin(), features.keypoints.begin() + count},
          features.descriptors.rowRange(0, count)};
}

// Euclidean distances of all pairs of rows: CV_32F, a.rows x b.rows. A third of the time that
// OpenCV's matrix product takes for the same.
cv::Mat distances_of(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat left, right, distances;
  a.convertTo(left, CV_32F);
  b.convertTo(right, CV_32F);
  cv::batchDistance(left, right, distances, CV_32F, cv::noArray(), cv::NORM_L2);
  return distances;
}

float apart(const Keypoint& a, const Keypoint& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

// For every feature the distance of the most similar one at another place of the same view.
std::vector<float> nearest_elsewhere(const Features& features) {
  const cv::Mat distances = distances_of(features.descriptors, features.descriptors);
  std::vector<float> nearest(features.size(), kFar);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Keypoint& k = features.keypoints[i];
    const auto* row = distances.ptr<float>(static_cast<int>(i));
    for (std::size_t j = 0; j < features.size(); ++j) {
      const Keypoint& other = features.keypoints[j];
      // One spot often gives several features, of other scale or orientation.
      if (apart(k, other) > 3 * std::max(k.scale, other.scale)) {
        nearest[i] = std::min(nearest[i], row[j]);
      }
    }
  }
  return nearest;
}

// Median distance of a feature and its likeness in the copy; kFar if none was found again.
float typical_distance(const std::vector<float>& likenesses) {
  std::vector<float> known;
  for (const float d : likenesses) {
    if (d < kFar) known.push_back(d);
  }
  if (known.empty()) return kFar;
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  return *middle;
}

void assess_sizes(const View& view, const std::vector<float>& elsewhere,
                  const QualityOptions& options, ViewQuality& quality) {
  const auto extractor = make_extractor(options.feature);
  const auto needed = static_cast<std::size_t>(options.needed_matches);
  quality.smallest_size_px = quality.size_px;
  double factor = 1;
  for (int step = 1;; ++step) {
    factor /= std::numbers::sqrt2;
    constexpr double kSmallest = 12;  // px: no detector finds several features on less
    if (factor * quality.size_px < kSmallest) break;
    ShortenedFeatures reduced =
        extract_shortened(view.picture, view.mask, factor, factor, *extractor);
    reduced.features = strongest_of(reduced.features);
    const auto likenesses = find_likenesses(view.features, reduced);
    if (step == 1) {
      const float same = typical_distance(likenesses);
      const auto alike = std::count_if(elsewhere.begin(), elsewhere.end(), [&](float d) {
        return same < kFar && same >= options.max_ratio * d;
      });
      quality.self_similarity = static_cast<double>(alike) / static_cast<double>(elsewhere.size());
    }
    std::size_t right = 0;
    for (std::size_t i = 0; i < likenesses.size(); ++i)
      right += likenesses[i] < options.max_ratio * elsewhere[i];
    if (right < needed) break;
    quality.smallest_size_px = factor * quality.size_px;
  }
}

double coverage_of(const View& view) {
  const cv::Mat& mask = view.mask;
  const int cell = std::max(1, cvRound(std::sqrt(cv::countNonZero(mask) / 64.0)));
  const cv::Rect box = cv::boundingRect(mask);
  const int columns = (box.width + cell - 1) / cell, rows = (box.height + cell - 1) / cell;
  cv::Mat hit = cv::Mat::zeros(std::max(1, rows), std::max(1, columns), CV_8U);
  for (const Keypoint& k : view.features.keypoints) {
    const int x = (cvRound(k.x) - box.x) / cell, y = (cvRound(k.y) - box.y) / cell;
    if (x >= 0 && y >= 0 && x < columns && y < rows) hit.at<uchar>(y, x) = 1;
  }
  int all = 0, covered = 0;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const cv::Rect area = cv::Rect(box.x + x * cell, box.y + y * cell, cell, cell) & box;
      if (2 * cv::countNonZero(mask(area)) < cell * cell) continue;
      ++all;
      covered += hit.at<uchar>(y, x);
    }
  }
  return all > 0 ? covered / static_cast<double>(all) : 0;
}

std::vector<std::shared_ptr<const View>> without(
    const View& view, const std::vector<std::shared_ptr<const View>>& views) {
  std::vector<std::shared_ptr<const View>> others;
  for (const auto& other : views) {
    if (other && other.get() != &view) others.push_back(other);
  }
  return others;
}

double redundancy_of(const View& view, const std::vector<std::shared_ptr<const View>>& others,
                     const std::vector<float>& elsewhere, double max_ratio) {
  std::vector<char> known(view.features.size(), 0);
  for (const auto& other : others) {
    if (other->features.empty()) continue;
    if (other->features.descriptors.cols != view.features.descriptors.cols) continue;
    const cv::Mat distances =
        distances_of(view.features.descriptors, strongest_of(other->features).descriptors);
    for (int i = 0; i < distances.rows; ++i) {
      const auto* row = distances.ptr<float>(i);
      const float best = *std::min_element(row, row + distances.cols);
      const auto at = static_cast<std::size_t>(i);
      if (best < max_ratio * elsewhere[at]) known[at] = 1;
    }
  }
  return static_cast<double>(std::count(known.begin(), known.end(), 1)) /
         static_cast<double>(known.size());
}

std::string percent(double share) {
  return std::to_string(cvRound(100 * share)) + " %";
}

std::string cut_sides(const cv::Mat& mask) {
  const cv::Rect box = cv::boundingRect(mask);
  if (box.empty() || box.size() == mask.size()) return "";  // the whole picture is the object
  std::string sides;
  const auto add = [&](bool cut, const char* name) {
    if (cut) sides += (sides.empty() ? "" : ", ") + std::string(name);
  };
  add(box.x == 0, "left");
  add(box.br().x == mask.cols, "right");
  add(box.y == 0, "upper");
  add(box.br().y == mask.rows, "lower");
  return sides;
}

void advise(const View& view, const QualityOptions& options, ViewQuality& quality) {
  auto& advice = quality.advice;
  const std::string cut = view.mask.empty() ? "" : cut_sides(view.mask);
  if (!cut.empty()) {
    advice.push_back("The object is cut by the " + cut +
                     " border of the picture; move it to the middle.");
  }
  // A turned, smaller or half hidden object loses about three of four features.
  if (quality.features < 4 * static_cast<std::size_t>(options.needed_matches)) {
    advice.push_back("Only " + std::to_string(quality.features) +
                     " features; take the picture from nearer, sharper, with more light, or show a "
                     "side with more print.");
  }
  if (quality.self_similarity > 0.5) {
    advice.push_back("The texture repeats: " + percent(quality.self_similarity) +
                     " of the features look like another place of the object; teach sides with "
                     "print that does not repeat.");
  }
  if (quality.coverage < 0.25 && quality.features > 0) {
    advice.push_back("Features cover only " + percent(quality.coverage) +
                     " of the object; when that part is hidden it will not be recognised.");
  }
  if (quality.smallest_size_px > 0.6 * quality.size_px) {
    advice.push_back("It will only be recognised from about " +
                     std::to_string(cvRound(quality.smallest_size_px)) +
                     " px on, hardly less than in this picture; take it from nearer or with more "
                     "pixels.");
  }
  if (quality.redundancy > options.redundant_from) {
    advice.push_back("It adds little: " + percent(quality.redundancy) +
                     " of its features are known from the other views.");
  }
  if (!std::isnan(quality.next_yaw_deg)) {
    advice.push_back("Teach a view at " + std::to_string(cvRound(quality.next_yaw_deg)) +
                     " degrees next; the gap there is the largest.");
  }
}

}  // namespace

void QualityOptions::describe(OptionList& list) {
  list.group("feature", feature);
  list.add("max_ratio", max_ratio, {0, 1}, "", "Right / wrong distance of a feature told apart.");
  list.add("needed_matches", needed_matches, {3, 1'000'000}, "",
           "Matches that recognition needs to be sure.");
  list.add("max_gap_deg", max_gap_deg, {1, 180}, "deg", "Largest turn between two views.");
  list.add("redundant_from", redundant_from, {0, 1}, "",
           "Share of known features from which a view adds little.");
}

double next_yaw(const std::vector<double>& yaws_deg, double max_gap_deg) {
  std::vector<double> yaws;
  for (const double yaw : yaws_deg) {
    if (std::isfinite(yaw)) yaws.push_back(yaw - 360 * std::floor(yaw / 360));
  }
  if (yaws.empty()) return 0;
  std::sort(yaws.begin(), yaws.end());
  double start = 0, widest = 0;
  for (std::size_t i = 0; i < yaws.size(); ++i) {
    const double end = i + 1 < yaws.size() ? yaws[i + 1] : yaws[0] + 360;
    if (end - yaws[i] > widest) {
      start = yaws[i];
      widest = end - yaws[i];
    }
  }
  constexpr double kRounding = 0.5;  // deg: turntables are set by hand
  if (widest <= max_gap_deg + kRounding) return std::nan("");
  const double next = start + widest / std::ceil((widest - kRounding) / max_gap_deg);
  return next >= 360 ? next - 360 : next;
}

double measure_redundancy(const View& view, const std::vector<std::shared_ptr<const View>>& others,
                          const QualityOptions& options) {
  validate_options(options);
  if (view.features.empty()) return 0;
  View strong = view;
  strong.features = strongest_of(view.features);
  return redundancy_of(strong, without(view, others), nearest_elsewhere(strong.features),
                       options.max_ratio);
}

ViewQuality assess_view(const View& view, const std::vector<std::shared_ptr<const View>>& others,
                        const QualityOptions& options) {
  validate_options(options);
  ViewQuality quality;
  quality.features = view.features.size();
  cv::Rect2f box;
  if (!view.outline.empty()) box = cv::boundingRect(view.outline);
  quality.size_px = std::max(box.width, box.height);
  if (!std::isnan(view.yaw_deg)) {
    std::vector<double> yaws{view.yaw_deg};
    for (const auto& other : others) {
      if (other) yaws.push_back(other->yaw_deg);
    }
    quality.next_yaw_deg = next_yaw(yaws, options.max_gap_deg);
  }
  if (!view.features.empty()) {
    if (!view.mask.empty()) quality.coverage = coverage_of(view);
    View strong = view;
    strong.features = strongest_of(view.features);
    const std::vector<float> elsewhere = nearest_elsewhere(strong.features);
    quality.redundancy = redundancy_of(strong, without(view, others), elsewhere, options.max_ratio);
    if (!view.picture.empty()) assess_sizes(strong, elsewhere, options, quality);
  }
  advise(view, options, quality);
  return quality;
}

}  // namespace posevote
