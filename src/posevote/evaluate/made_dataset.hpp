// A small data set of drawn pictures, for tests.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace posevote {

/// A folder of its own, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "posevote-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A cover full of discs and bars, another one for each seed.
inline cv::Mat draw_cover(int seed, cv::Size size = {160, 160}) {
  cv::RNG rng(static_cast<std::uint64_t>(seed) * 7919 + 1);
  cv::Mat cover(size, CV_8UC3, cv::Scalar(rng.uniform(90, 160), rng.uniform(90, 160), 128));
  for (int i = 0; i < 60; ++i) {
    const cv::Point at(rng.uniform(0, size.width), rng.uniform(0, size.height));
    const cv::Scalar colour(rng.uniform(0, 256), rng.uniform(0, 256), rng.uniform(0, 256));
    if (i % 2 == 0)
      cv::circle(cover, at, rng.uniform(3, 14), colour, cv::FILLED, cv::LINE_AA);
    else
      cv::rectangle(cover, {at, cv::Size(rng.uniform(4, 26), rng.uniform(4, 26))}, colour,
                    cv::FILLED);
  }
  return cover;
}

/// Adds tests to a data set whose covers are taught from their whole pictures.
class MadeDataset {
 public:
  explicit MadeDataset(int objects = 2) {
    std::filesystem::create_directories(folder() / "train");
    for (int i = 0; i < objects; ++i) {
      const std::string name = "cover-" + std::to_string(i);
      cv::imwrite((folder() / "train" / (name + ".png")).string(), draw_cover(i));
      document_["objects"].push_back(
          {{"name", name}, {"views", {{{"image", "train/" + name + ".png"}, {"yaw", 180}}}}});
    }
    document_["name"] = "made";
    document_["tests"] = nlohmann::json::array();
    save();
  }

  /// A picture with one cover (-1: none) at (100, 50) on a plain ground, and more fields of the
  /// test.
  void add_test(const std::string& group, int cover, const nlohmann::json& fields = {}) {
    const std::string image = "test-" + std::to_string(document_["tests"].size()) + ".png";
    cv::Mat scene(240, 400, CV_8UC3, cv::Scalar::all(120));
    nlohmann::json objects = nlohmann::json::array();
    if (cover >= 0) {
      draw_cover(cover).copyTo(scene(cv::Rect(100, 50, 160, 160)));
      objects.push_back(
          {{"name", "cover-" + std::to_string(cover)}, {"box", {100, 50, 160, 160}}, {"yaw", 180}});
    }
    cv::imwrite((folder() / image).string(), scene);
    nlohmann::json test{{"image", image}, {"group", group}, {"objects", objects}};
    if (fields.is_object()) test.update(fields);
    document_["tests"].push_back(test);
    save();
  }

  /// The first object is taught from a picture of its cover on a ground, the ground alone, and its
  /// true silhouette.
  void teach_first_by_background() {
    cv::Mat ground(240, 320, CV_8UC3), mask = cv::Mat::zeros(240, 320, CV_8U);
    cv::RNG(5).fill(ground, cv::RNG::NORMAL, 150, 3);
    cv::imwrite((folder() / "train/background.png").string(), ground);
    draw_cover(0).copyTo(ground(cv::Rect(80, 40, 160, 160)));
    mask(cv::Rect(80, 40, 160, 160)).setTo(255);
    cv::imwrite((folder() / "train/cover-0.png").string(), ground);
    cv::imwrite((folder() / "train/truth.png").string(), mask);
    document_["objects"][0]["views"][0].update(
        nlohmann::json{{"background", "train/background.png"}, {"truth_mask", "train/truth.png"}});
    save();
  }

  [[nodiscard]] std::filesystem::path folder() const { return folder_.path(); }
  nlohmann::json& document() { return document_; }
  void save() { std::ofstream(folder() / "dataset.json") << document_.dump(1); }

 private:
  TemporaryFolder folder_;
  nlohmann::json document_{{"objects", nlohmann::json::array()}};
};

}  // namespace posevote
