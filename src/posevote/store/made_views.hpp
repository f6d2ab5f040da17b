// Views made for tests: small, different for each seed, complete.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <string>

#include "posevote/core/error.hpp"
#include "posevote/store/taught_view.hpp"

namespace posevote {

inline Features made_features(int seed, int count = 5, int dimension = 64) {
  cv::RNG random(static_cast<std::uint64_t>(seed) + 1);
  Features features;
  for (int i = 0; i < count; ++i)
    features.keypoints.push_back({random.uniform(0.F, 20.F), random.uniform(0.F, 16.F),
                                  random.uniform(1.F, 4.F), random.uniform(-3.F, 3.F),
                                  random.uniform(0.F, 9.F), static_cast<std::int8_t>(i % 3 - 1)});
  if (count == 0) return features;
  features.descriptors.create(count, dimension, CV_32F);
  random.fill(features.descriptors, cv::RNG::UNIFORM, -1, 1);
  return features;
}

inline TaughtView made_view(int seed, int count = 5) {
  TaughtView taught;
  View& view = taught.view;
  view.yaw_deg = 30.0 * seed;
  view.picture.create(16, 20, CV_8UC3);
  cv::RNG(static_cast<std::uint64_t>(seed) + 1).fill(view.picture, cv::RNG::UNIFORM, 0, 256);
  view.image_size = view.picture.size();
  view.mask = cv::Mat::zeros(view.image_size, CV_8U);
  view.mask(cv::Rect(4, 4, 10, 8)) = 255;
  view.outline = {{4, 4}, {13, 4}, {13, 11}, {4, 11.5}};
  view.centre = {8.5F, 7.25F};
  view.features = made_features(seed, count);
  taught.method = "mask";
  taught.provenance = {"picture" + std::to_string(seed) + ".png", "", "1.2.3"};
  return taught;
}

/// A folder of its own that is gone at the end of the test.
struct ScratchFolder {
  std::filesystem::path path;
  ScratchFolder() {
    static int count = 0;
    path = std::filesystem::temp_directory_path() /
           ("posevote_test." + std::to_string(getpid()) + "." + std::to_string(count++));
    std::filesystem::create_directories(path);
  }
  ~ScratchFolder() { std::filesystem::remove_all(path); }
  std::string file(const std::string& name) const { return (path / name).string(); }
};

/// The error that `action` throws, as "code: sentence"; "" when it throws none.
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return std::string(to_string(error.code())) + ": " + error.what();
  }
  return "";
}

}  // namespace posevote
