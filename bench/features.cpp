// bench_features [FOLDER] [--rounds N] [--picture FILE] [--threads-only]
//
// Time of our SURF against OpenCV's ORB and dlib's SURF at the same number of key points, in one
// process and in turns, so that all suffer alike from whatever else the machine does. The pictures
// are mosaics of the photographs in FOLDER (default ../shared/data/oxford-affine) at their own
// resolution, or FILE scaled to each size. Printed per size and number of key points: the median
// time of each, the median of the ratios of neighbouring turns (wall clock and processor time), our
// stages, and how many times longer these take than the memory for the numbers that they read and
// write (each once from a sequential stream: the least that any method needs). Before everything
// else the machine's memory bandwidth and our peak memory at 8 megapixels. The rows "default" are
// what recognition does with a picture of that size, the picture doubled where it is small.
//
// A second table compares two threads for one picture with one thread, on frames one after another
// as of a video, and on one after a pause as of a camera; and with what two threads that do not
// know of each other get done, a picture each: that is what the machine gives to two.
#include <dlib/image_keypoint.h>
#include <dlib/opencv.h>
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <latch>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <string>
#include <thread>

#include "posevote/feature/surf/surf.hpp"

namespace {

using posevote::surf::StageTimes;
using posevote::surf::Workspace;

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::nth_element(values, values.begin() + values.size() / 2);
  return values[values.size() / 2];
}

struct Duration {
  double wall = 0, processor = 0;  // ms; the processor's is of the calling thread alone
};

double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

Duration time_of(const std::function<void()>& action) {
  const auto start = std::chrono::steady_clock::now();
  const double processor = processor_ms();
  action();
  const double used = processor_ms() - processor;
  const auto wall = std::chrono::steady_clock::now() - start;
  return {std::chrono::duration<double, std::milli>(wall).count(), used};
}

// All photographs of the folder, again and again, row by row, until the canvas is full.
cv::Mat mosaic(const std::filesystem::path& folder, cv::Size size) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".png" || entry.path().extension() == ".jpg")
      files.push_back(entry.path());
  std::ranges::sort(files);
  if (files.empty()) throw std::runtime_error("no pictures in " + folder.string());
  cv::Mat canvas(size, CV_8U);
  std::size_t next = 0;
  for (int y = 0, row_height = 0; y < size.height; y += row_height) {
    row_height = size.height - y;
    for (int x = 0; x < size.width;) {
      const cv::Mat photo =
          cv::imread(files[next++ * 7 % files.size()].string(), cv::IMREAD_GRAYSCALE);
      if (photo.empty()) continue;
      if (x == 0) row_height = std::min(row_height, photo.rows);
      const int width = std::min(photo.cols, size.width - x);
      const int height = std::min(photo.rows, row_height);
      canvas(cv::Rect(x, y, width, row_height)).setTo(0);
      photo(cv::Rect(0, 0, width, height)).copyTo(canvas(cv::Rect(x, y, width, height)));
      x += width;
    }
  }
  return canvas;
}

double bandwidth_gb() {
  constexpr std::size_t kBytes = 64 << 20;
  std::vector<char> from(kBytes, 1), to(kBytes, 2);
  std::vector<double> rates;
  for (int round = 0; round < 9; ++round) {
    const auto time = time_of([&] { std::memcpy(to.data(), from.data(), kBytes); });
    rates.push_back(2 * static_cast<double>(kBytes) / time.processor * 1e-6);
  }
  return median(rates);
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// Bytes that a step has to read and write at least.
struct Traffic {
  double integral, hessian, orientation, descriptor;
};
Traffic traffic_of(double pixels, double keypoints) {
  const double sums = pixels * 4 * 4 / 3;  // of all levels
  return {pixels + sums, sums, keypoints * 12 * 12 * 4, keypoints * (16 * 16 * 4 + 64) * 4};
}

struct Series {
  std::vector<double> wall, processor;
  void add(const Duration& duration) {
    wall.push_back(duration.wall);
    processor.push_back(duration.processor);
  }
};

double ratio(const std::vector<double>& ours, const std::vector<double>& theirs) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(ours.size(), theirs.size()); ++i)
    ratios.push_back(ours[i] / theirs[i]);
  return median(ratios);
}

std::vector<double> column(const std::vector<StageTimes>& stages, double StageTimes::*field) {
  std::vector<double> values;
  values.reserve(stages.size());
  for (const StageTimes& times : stages) values.push_back(times.*field);
  return values;
}

struct Case {
  std::string name;
  posevote::FeatureOptions options;
};

void compare(const cv::Mat& picture, const Case& of, double bandwidth, int rounds) {
  const auto& options = of.options;
  const int count = options.max_features;
  Workspace workspace;
  const auto orb = cv::ORB::create(count);
  Series ours, orbs, dlibs;
  std::vector<StageTimes> stages;
  std::size_t found = 0, orb_found = 0, dlib_found = 0;
  for (int round = -1; round < rounds; ++round) {  // the first one fills caches and buffers
    const auto a = time_of([&] { found = workspace.extract(picture, {}, options).size(); });
    const auto b = time_of([&] {
      std::vector<cv::KeyPoint> points;
      cv::Mat rows;
      orb->detectAndCompute(picture, {}, points, rows);
      orb_found = points.size();
    });
    if (round < 0) continue;
    ours.add(a);
    orbs.add(b);
    stages.push_back(workspace.times());
    if (round % 4 == 0)  // many times slower than the others
      dlibs.add(time_of([&] {
        dlib_found =
            dlib::get_surf_points(dlib::cv_image<unsigned char>(picture), count, 1.0).size();
      }));
  }
  Series every_fourth;
  for (std::size_t i = 0; i < ours.wall.size(); i += 4)
    every_fourth.add({ours.wall[i], ours.processor[i]});
  const auto stage = [&](double StageTimes::*field) { return median(column(stages, field)); };
  const double integral = stage(&StageTimes::integral), hessian = stage(&StageTimes::hessian);
  const double orientation = stage(&StageTimes::orientation);
  const double descriptor = stage(&StageTimes::descriptor);
  std::printf(
      "%4dx%-4d %-7s %5zu/%5zu/%5zu | %7.2f %7.2f %8.2f | %5.2f (%4.2f)  %5.1f (%4.1f)"
      " | %5.2f %6.2f %5.2f %5.2f %5.2f",
      picture.cols, picture.rows, of.name.c_str(), found, orb_found, dlib_found, median(ours.wall),
      median(orbs.wall), median(dlibs.wall), ratio(ours.wall, orbs.wall),
      ratio(ours.processor, orbs.processor), ratio(dlibs.wall, every_fourth.wall),
      ratio(dlibs.processor, every_fourth.processor), integral, hessian,
      stage(&StageTimes::suppression), orientation, descriptor);
  const double pixels = static_cast<double>(picture.total()) * (options.surf.double_size ? 4 : 1);
  const Traffic bytes = traffic_of(pixels, static_cast<double>(found));
  const auto times_of_memory = [&](double ms, double moved) {
    return ms * 1e6 * bandwidth / moved;
  };
  std::printf(" | %4.1f %4.1f %4.1f %4.1f\n", times_of_memory(integral, bytes.integral),
              times_of_memory(hessian, bytes.hessian),
              times_of_memory(orientation, bytes.orientation),
              times_of_memory(descriptor, bytes.descriptor));
  std::fflush(stdout);
}

constexpr int kFrames = 8;
constexpr std::chrono::milliseconds kPause(5);

void repeat(const std::function<void()>& action) {
  for (int frame = 0; frame < kFrames; ++frame) action();
}

// Of each of some frames of a video: the one before them has just been done.
double time_of_frame(const std::function<void()>& action) {
  action();
  return time_of([&] { repeat(action); }).wall / kFrames;
}

double time_after_pause(const std::function<void()>& action) {
  std::this_thread::sleep_for(kPause);
  return time_of(action).wall;
}

// In turns: frames on one thread, on two threads, both again after a pause, and frames of two
// videos with a thread each.
void compare_threads(const cv::Mat& picture, const Case& of, int rounds) {
  auto two = of.options;
  two.surf.threads = 2;
  Workspace single, shared, other;
  const auto on_one = [&] { (void)single.extract(picture, {}, of.options); };
  const auto on_two = [&] { (void)shared.extract(picture, {}, two); };
  const auto on_another = [&] { (void)other.extract(picture, {}, of.options); };
  std::vector<double> ones, twos, rested_ones, rested_twos, pairs;
  std::vector<StageTimes> one_stages, two_stages;
  for (int round = -1; round < rounds; ++round) {
    const double one = time_of_frame(on_one);
    const StageTimes one_times = single.times();
    const double both = time_of_frame(on_two);
    const StageTimes two_times = shared.times();
    const double rested_one = time_after_pause(on_one), rested_both = time_after_pause(on_two);
    std::latch awake(2);
    std::thread beside([&] {
      on_another();
      awake.arrive_and_wait();
      repeat(on_another);
    });
    on_one();
    awake.arrive_and_wait();
    const auto pair = time_of([&] {
      repeat(on_one);
      beside.join();
    });
    if (round < 0) continue;
    ones.push_back(one);
    twos.push_back(both);
    rested_ones.push_back(rested_one);
    rested_twos.push_back(rested_both);
    pairs.push_back(pair.wall / kFrames);
    one_stages.push_back(one_times);
    two_stages.push_back(two_times);
  }
  std::printf("%4dx%-4d %-7s %6d | %7.2f %7.2f %7.2f | %4.2f %4.2f %4.2f |", picture.cols,
              picture.rows, of.name.c_str(), of.options.max_features, median(ones), median(twos),
              median(pairs), ratio(ones, twos), ratio(rested_ones, rested_twos),
              2 * ratio(ones, pairs));
  for (const auto field : {&StageTimes::integral, &StageTimes::hessian, &StageTimes::suppression,
                           &StageTimes::orientation, &StageTimes::descriptor})
    std::printf(" %4.2f", ratio(column(one_stages, field), column(two_stages, field)));
  std::printf("\n");
  std::fflush(stdout);
}

void print_memory(const cv::Mat& picture) {
  const double before = peak_mb();
  posevote::FeatureOptions options;
  options.max_features = 5000;
  Workspace workspace;
  (void)workspace.extract(picture, {}, options);
  const double used = peak_mb() - before;
  const double floats = static_cast<double>(picture.total()) * 4 / (1 << 20);
  std::printf("our peak memory at %dx%d: %.0f MB = %.2f times the picture in floats\n",
              picture.cols, picture.rows, used, used / floats);
}

std::vector<Case> cases_of(cv::Size size) {
  std::vector<Case> cases;
  for (const int count : {500, 1000, 2000, 5000}) {
    cases.push_back({"", {}});
    cases.back().options.max_features = count;
  }
  if (size.area() < cases[0].options.double_below_px) {
    cases.push_back({"default", {}});
    cases.back().options.surf.double_size = true;
  }
  return cases;
}

int rounds_of(const cv::Mat& picture, int rounds) {
  return picture.cols > 2000 ? std::max(1, rounds / 3) : rounds;
}

void compare_with_others(std::span<const cv::Mat> pictures, int rounds) {
  const double bandwidth = bandwidth_gb();
  std::printf("memory bandwidth (copy, read + written): %.1f GB/s\n\n", bandwidth);
  std::printf(
      "ms, medians of %d turns; ratios: medians of the turns', in brackets of processor time\n"
      "%-17s %-17s | %7s %7s %8s | %12s  %13s | %s | times of the memory's\n",
      rounds, "size", "found/orb/dlib", "surf", "orb", "dlib", "surf/orb", "dlib/surf",
      "integral hessian suppression orientation descriptor");
  for (const cv::Mat& picture : pictures)
    for (const Case& of : cases_of(picture.size()))
      compare(picture, of, bandwidth, rounds_of(picture, rounds));
}

void run(const std::filesystem::path& folder, const std::string& file, int rounds,
         bool threads_only) {
  cv::setNumThreads(1);
  const auto picture_of = [&](cv::Size size) {
    if (file.empty()) return mosaic(folder, size);
    cv::Mat picture = cv::imread(file, cv::IMREAD_GRAYSCALE);
    if (picture.empty()) throw std::runtime_error("cannot read " + file);
    cv::resize(picture, picture, size, 0, 0, cv::INTER_AREA);
    return picture;
  };
  const cv::Mat pictures[] = {picture_of({640, 480}), picture_of({1920, 1080}),
                              picture_of({3264, 2448})};
  if (!threads_only) {
    print_memory(pictures[2]);
    compare_with_others(pictures, rounds);
  }
  std::printf(
      "\nms a frame of a video, and how many times as much is done: two threads for one frame, the "
      "same after a pause as a camera makes it, two that each have a video of their own\n"
      "%-17s %6s | %7s %7s %7s | %4s %4s %4s | stages as above, two threads\n",
      "size", "wanted", "one", "two", "2 apart", "two", "cam.", "2 a.");
  for (const cv::Mat& picture : pictures)
    for (const Case& of : cases_of(picture.size()))
      compare_threads(picture, of, rounds_of(picture, rounds));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    std::filesystem::path folder = "../shared/data/oxford-affine";
    std::string file;
    int rounds = 31;
    bool threads_only = false;
    for (int i = 1; i < argc; ++i) {
      const std::string argument = argv[i];
      if (argument == "--rounds" && i + 1 < argc)
        rounds = std::max(1, std::stoi(argv[++i]));
      else if (argument == "--picture" && i + 1 < argc)
        file = argv[++i];
      else if (argument == "--threads-only")
        threads_only = true;
      else
        folder = argument;
    }
    run(folder, file, rounds, threads_only);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_features: %s\n", error.what());
    return 1;
  }
  return 0;
}
