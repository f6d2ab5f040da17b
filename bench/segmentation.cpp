// How well the background difference finds the object: every view of the given datasets that has a
// background picture and a true mask. Usage: bench_segmentation [--sheets FOLDER] [--every N]
// DATASET...
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "posevote/core/error.hpp"
#include "posevote/teach/segment.hpp"

namespace fs = std::filesystem;

namespace {

struct Case {
  std::string name;
  double iou = 0;
  double false_share = 0;   // pixels wrongly taken, relative to the object's area
  double shadow_share = 0;  // those of them that are darker than the background picture
  double time_ms = 0;       // of the processor, all threads
  std::string refused;
};

double share(const cv::Mat& part, double whole) {
  return cv::countNonZero(part) / whole;
}

// asked.
cv::Mat darker_pixels(const cv::Mat& picture, const cv::Mat& background) {
  cv::Mat p, b;
  cv::cvtColor(picture, p, cv::COLOR_BGR2GRAY);
  cv::cvtColor(background, b, cv::COLOR_BGR2GRAY);
  return p < b;
}

void write_sheet(const fs::path& file, const cv::Mat& picture, const cv::Mat& background,
                 const cv::Mat& truth, const cv::Mat& mask) {
  cv::Mat marked = picture.clone();
  marked.setTo(cv::Scalar(0, 0, 255), mask & ~truth);
  marked.setTo(cv::Scalar(255, 0, 255), ~mask & truth);
  cv::Mat sheet;
  cv::hconcat(std::vector<cv::Mat>{background, picture, marked}, sheet);
  cv::imwrite(file.string(), sheet);
}

Case measure(const fs::path& folder, const nlohmann::json& view, const std::string& sheets) {
  const auto read = [&](const char* field, int flags) {
    const std::string file = (folder / view.at(field).get<std::string>()).string();
    cv::Mat image = cv::imread(file, flags);
    if (image.empty()) throw std::runtime_error("cannot read " + file);
    return image;
  };
  const cv::Mat picture = read("image", cv::IMREAD_COLOR);
  const cv::Mat background = read("background", cv::IMREAD_COLOR);
  const cv::Mat truth = read("truth_mask", cv::IMREAD_GRAYSCALE) > 127;
  Case result;
  result.name = view.at("image").get<std::string>();
  cv::Mat mask = cv::Mat::zeros(picture.size(), CV_8U);
  const std::clock_t start = std::clock();
  try {
    mask = posevote::segment_by_background(picture, background);
  } catch (const posevote::Error& error) {
    result.refused = error.what();
  }
  result.time_ms = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const double area = std::max(1, cv::countNonZero(truth));
  const cv::Mat wrong = mask & ~truth;
  result.iou = share(mask & truth, std::max(1, cv::countNonZero(mask | truth)));
  result.false_share = share(wrong, area);
  result.shadow_share = share(wrong & darker_pixels(picture, background), area);
  if (!sheets.empty()) {
    std::string flat = result.name;
    std::replace(flat.begin(), flat.end(), '/', '_');
    char score[16];
    std::snprintf(score, sizeof score, "%.3f_", result.iou);
    write_sheet(fs::path(sheets) / (score + flat + ".png"), picture, background, truth, mask);
  }
  return result;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

void report(const std::string& name, std::vector<Case> cases) {
  const auto column = [&](double Case::*field) {
    std::vector<double> values;
    for (const Case& c : cases) values.push_back(c.*field);
    return values;
  };
  const auto refused =
      std::count_if(cases.begin(), cases.end(), [](const Case& c) { return !c.refused.empty(); });
  const auto iou = column(&Case::iou);
  const auto shadow = column(&Case::shadow_share), wrong = column(&Case::false_share);
  double sum_shadow = 0, sum_wrong = 0;
  for (const double s : shadow) sum_shadow += s;
  for (const double s : wrong) sum_wrong += s;
  const double n = std::max<double>(1, static_cast<double>(cases.size()));
  std::printf("%-20s views %4zu  refused %2td  IoU median %.3f  p5 %.3f  min %.3f\n", name.c_str(),
              cases.size(), refused, quantile(iou, 0.5), quantile(iou, 0.05), quantile(iou, 0));
  std::printf(
      "  of the object's area: taken wrongly mean %.2f %% p95 %.2f %%, shadow mean %.2f %% "
      "p95 %.2f %% max %.2f %%\n",
      100 * sum_wrong / n, 100 * quantile(wrong, 0.95), 100 * sum_shadow / n,
      100 * quantile(shadow, 0.95), 100 * quantile(shadow, 1));
  std::printf("  processor time per view median %.0f ms  p95 %.0f ms\n",
              quantile(column(&Case::time_ms), 0.5), quantile(column(&Case::time_ms), 0.95));
  std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) { return a.iou < b.iou; });
  for (std::size_t i = 0; i < std::min<std::size_t>(8, cases.size()); ++i) {
    const Case& c = cases[i];
    std::printf("    %.3f  wrong %5.2f %%  shadow %5.2f %%  %s %s\n", c.iou, 100 * c.false_share,
                100 * c.shadow_share, c.name.c_str(), c.refused.c_str());
  }
}

void run(const fs::path& folder, const std::string& sheets, int every) {
  std::ifstream file(folder / "dataset.json");
  if (!file) throw std::runtime_error("no dataset.json in " + folder.string());
  const auto dataset = nlohmann::json::parse(file);
  std::vector<Case> cases;
  int number = 0;
  for (const auto& object : dataset.at("objects")) {
    for (const auto& view : object.at("views")) {
      const bool fit = view.contains("background") && view.contains("truth_mask");
      if (fit && number++ % every == 0) {
        cases.push_back(measure(folder, view, sheets));
      }
    }
  }
  report(dataset.at("name").get<std::string>(), std::move(cases));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) try {
  std::string sheets;
  int every = 1;
  std::vector<std::string> folders;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--sheets" && i + 1 < argc)
      sheets = argv[++i];
    else if (std::string(argv[i]) == "--every" && i + 1 < argc)
      every = std::max(1, std::atoi(argv[++i]));
    else
      folders.emplace_back(argv[i]);
  }
  if (folders.empty()) {
    std::fprintf(stderr, "Usage: bench_segmentation [--sheets FOLDER] [--every N] DATASET...\n");
    return 2;
  }
  if (!sheets.empty()) fs::create_directories(sheets);
  for (const std::string& folder : folders) run(folder, sheets, every);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
