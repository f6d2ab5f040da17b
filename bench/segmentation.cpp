// How well the background difference finds the object: every view of the given datasets that has a
// background picture and a true mask. Usage: bench_segmentation [--sheets FOLDER] [--every N]
// [--set NAME=VALUE]... [DATASET...]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/evaluator.hpp"
#include "posevote/evaluate/silhouette.hpp"
#include "posevote/evaluate/statistics.hpp"
#include "posevote/feature/features.hpp"
#include "posevote/teach/segment.hpp"

namespace fs = std::filesystem;
using namespace posevote;

namespace {

struct Arguments {
  std::string sheets;
  std::size_t every = 1;
  SegmentOptions segment;
  std::vector<fs::path> datasets;
};

struct Measured {
  SilhouetteCase silhouette;
  std::string reason;  // why it was refused
  double time_ms = 0;  // of the processor
};

double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Background, picture, and the picture with what is wrong: red is taken wrongly, magenta is
// missing.
void write_sheet(const fs::path& file, const ViewSource& source, const cv::Mat& truth,
                 const cv::Mat& mask) {
  cv::Mat marked = source.picture.clone(), sheet;
  marked.setTo(cv::Scalar(0, 0, 255), mask & ~truth);
  marked.setTo(cv::Scalar(255, 0, 255), ~mask & truth);
  cv::hconcat(std::vector<cv::Mat>{source.background, source.picture, marked}, sheet);
  cv::imwrite(file.string(), sheet);
}

Measured measure(const Dataset& dataset, const DatasetView& view, const Arguments& arguments) {
  ViewSource source;
  source.picture = read_dataset_image(dataset, view.image);
  source.background = read_dataset_image(dataset, view.background);
  const cv::Mat truth = to_grey(read_dataset_image(dataset, view.truth_mask)) > 127;
  Measured result;
  result.silhouette.image = view.image.generic_string();
  cv::Mat mask = cv::Mat::zeros(truth.size(), CV_8U);
  const double start = thread_ms();
  try {
    mask = segment_by_background(source.picture, source.background, arguments.segment);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::unusable_view) throw;
    result.silhouette.refused = true;
    result.reason = error.what();
  }
  result.time_ms = thread_ms() - start;
  result.silhouette.fit = compare_silhouettes(mask, truth, source.picture, source.background);
  if (!arguments.sheets.empty()) {
    std::string flat = fixed(result.silhouette.fit.iou, 3) + "_" + result.silhouette.image;
    std::ranges::replace(flat, '/', '_');
    write_sheet(fs::path(arguments.sheets) / (dataset.name + "_" + flat + ".png"), source, truth,
                mask);
  }
  return result;
}

void report(const std::string& name, const std::vector<Measured>& all) {
  std::vector<SilhouetteCase> cases;
  std::vector<double> times;
  for (const Measured& one : all) {
    cases.push_back(one.silhouette);
    times.push_back(one.time_ms);
  }
  std::cout << silhouette_table(name, cases).to_text() << "Processor time per view: median "
            << fixed(median(times), 0) << " ms, p95 " << fixed(quantile(times, 0.95), 0)
            << " ms. The worst:\n";
  const auto print = [](const SilhouetteCase& one) {
    std::printf("  IoU %.3f  wrong %5.2f %%  shadow %5.2f %%  %s%s\n", one.fit.iou,
                100 * one.fit.wrong_share, 100 * one.fit.shadow_share, one.image.c_str(),
                one.refused ? "  refused" : "");
  };
  std::cout << std::flush;
  for (const SilhouetteCase& one : worst_silhouettes(cases, 8)) print(one);
  for (const SilhouetteCase& one : cases)
    if (one.fit.shadow_share > shadow_limit) print(one);
  for (const Measured& one : all)
    if (!one.reason.empty())
      std::printf("  %s: %s\n", one.silhouette.image.c_str(), one.reason.c_str());
  std::printf("\n");
  std::fflush(stdout);
}

void run(const fs::path& folder, const Arguments& arguments) {
  const Dataset dataset = load_dataset(folder);
  std::vector<const DatasetView*> views;
  std::size_t number = 0;
  for (const DatasetObject& object : dataset.objects)
    for (const DatasetView& view : object.views)
      if (!view.background.empty() && !view.truth_mask.empty() && number++ % arguments.every == 0)
        views.push_back(&view);
  std::vector<Measured> measured(views.size());
  parallel_for(views.size(), 0,
               [&](std::size_t i) { measured[i] = measure(dataset, *views[i], arguments); });
  report(dataset.name, measured);
}

Arguments read_arguments(int argc, char** argv) {
  Arguments a;
  OptionList options;
  a.segment.describe(options);
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (!name.starts_with("--")) {
      a.datasets.emplace_back(name);
      continue;
    }
    if (i + 1 == argc) throw Error(ErrorCode::invalid_argument, name + " needs a value");
    const std::string value = argv[++i];
    if (name == "--sheets")
      a.sheets = value;
    else if (name == "--every")
      a.every = static_cast<std::size_t>(std::max(1, std::atoi(value.c_str())));
    else if (name == "--set")
      options.set(value.substr(0, value.find('=')), value.substr(value.find('=') + 1));
    else
      throw Error(ErrorCode::invalid_argument, "there is no option " + name);
  }
  if (a.datasets.empty())
    for (const char* folder :
         {"../shared/data/turntable", "../shared/data/turntable-robocup", "data/demo"})
      if (fs::exists(fs::path(folder) / "dataset.json")) a.datasets.emplace_back(folder);
  return a;
}

}  // namespace

int main(int argc, char** argv) try {
  const Arguments arguments = read_arguments(argc, argv);
  cv::setNumThreads(1);
  if (!arguments.sheets.empty()) fs::create_directories(arguments.sheets);
  for (const fs::path& folder : arguments.datasets) run(folder, arguments);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_segmentation: %s\n", error.what());
  return 1;
}
