#include "logic/scene_watch.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "posevote/feature/features.hpp"

namespace posevote::logic {
namespace {

constexpr int cells_across = 80;

cv::Mat shrink(const cv::Mat& picture) {
  const cv::Mat grey = to_grey(picture);
  const int columns = std::min(cells_across, grey.cols);
  const int rows = std::max(1, grey.rows * columns / grey.cols);
  cv::Mat small, cells;
  cv::resize(grey, small, {columns, rows}, 0, 0, cv::INTER_AREA);
  small.convertTo(cells, CV_32F);
  return cells;
}

float median(const cv::Mat& values) {
  std::vector<float> sorted(values.begin<float>(), values.end<float>());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

}  // namespace

void WatchOptions::describe(OptionList& list) {
  list.add("rest_s", rest_s, {0, 60}, "s", "Time without motion before a picture is taken.");
  list.add("min_difference", min_difference, {0, 255}, "",
           "Grey levels by which a part of the picture must differ to have changed.");
  list.add("min_changed_share", min_changed_share, {0, 1}, "",
           "Share of the picture that must differ for a change.");
}

SceneWatch::SceneWatch(const WatchOptions& options) : options_(options) {
  validate_options(options);
}

bool SceneWatch::differ(const cv::Mat& a, const cv::Mat& b) const {
  if (a.size() != b.size()) return true;
  const cv::Mat difference = a - b;
  const cv::Mat changed = cv::abs(difference - median(difference)) > options_.min_difference;
  return cv::countNonZero(changed) > options_.min_changed_share * static_cast<double>(a.total());
}

void SceneWatch::add(const cv::Mat& picture, double time_s) {
  const cv::Mat cells = shrink(picture);
  // Compared with the beginning of the rest as well: slow motion is motion.
  const bool moved =
      last_.empty() || time_s < last_s_ || differ(cells, last_) || differ(cells, since_rest_);
  if (moved) {
    since_rest_ = cells;
    rest_began_s_ = time_s;
  }
  last_ = cells;
  last_s_ = time_s;
}

bool SceneWatch::at_rest() const {
  return !last_.empty() && last_s_ - rest_began_s_ >= options_.rest_s;
}

bool SceneWatch::has_changed() const {
  return remembered_.empty() || last_.empty() || differ(last_, remembered_);
}

}  // namespace posevote::logic
