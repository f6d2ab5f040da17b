#include "posevote/evaluate/silhouette.hpp"

#include <algorithm>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/statistics.hpp"
#include "posevote/feature/features.hpp"

namespace posevote {
namespace {

std::vector<double> column(const std::vector<SilhouetteCase>& cases, double SilhouetteFit::*field) {
  std::vector<double> values;
  values.reserve(cases.size());
  for (const SilhouetteCase& one : cases) values.push_back(one.fit.*field);
  return values;
}

}  // namespace

SilhouetteFit compare_silhouettes(const cv::Mat& mask, const cv::Mat& truth, const cv::Mat& picture,
                                  const cv::Mat& background) {
  if (truth.size() != picture.size() || truth.size() != background.size() ||
      (!mask.empty() && mask.size() != truth.size()))
    throw Error(ErrorCode::invalid_argument,
                "a picture, its background, its mask and its true mask must be of one size");
  const cv::Mat taken = mask.empty() ? cv::Mat::zeros(truth.size(), CV_8U) : cv::Mat(mask > 127);
  const cv::Mat object = truth > 127, wrong = taken & ~object;
  const double area = std::max(1, cv::countNonZero(object));
  return {cv::countNonZero(taken & object) /
              static_cast<double>(std::max(1, cv::countNonZero(taken | object))),
          cv::countNonZero(wrong) / area,
          cv::countNonZero(wrong & (to_grey(picture) < to_grey(background))) / area};
}

Table silhouette_table(const std::string& name, const std::vector<SilhouetteCase>& cases) {
  Table table;
  table.header = {
      "data set", "views",      "refused",    "IoU median", "p5",
      "min",      "wrong mean", "shadow p95", "max",        "views > " + percent(shadow_limit, 0)};
  if (cases.empty()) return table;
  const auto iou = column(cases, &SilhouetteFit::iou);
  const auto shadow = column(cases, &SilhouetteFit::shadow_share);
  double wrong = 0;
  for (const SilhouetteCase& one : cases) wrong += one.fit.wrong_share;
  table.rows = {{name, std::to_string(cases.size()),
                 std::to_string(std::ranges::count(cases, true, &SilhouetteCase::refused)),
                 fixed(median(iou), 3), fixed(quantile(iou, 0.05), 3), fixed(quantile(iou, 0), 3),
                 percent(wrong / static_cast<double>(cases.size()), 2),
                 percent(quantile(shadow, 0.95), 2), percent(quantile(shadow, 1), 2),
                 std::to_string(std::ranges::count_if(
                     shadow, [](double share) { return share > shadow_limit; }))}};
  table.note =
      "Silhouettes found by background difference against the true ones; pixels taken wrongly, and "
      "those of them that are darker than the background, are shares of the object's area.";
  return table;
}

std::vector<SilhouetteCase> worst_silhouettes(std::vector<SilhouetteCase> cases,
                                              std::size_t count) {
  std::ranges::stable_sort(cases, {}, [](const SilhouetteCase& one) { return one.fit.iou; });
  cases.resize(std::min(cases.size(), count));
  return cases;
}

}  // namespace posevote
