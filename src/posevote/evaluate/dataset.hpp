// A dataset: a folder with `dataset.json` that says what to teach and what to ask.
//
//   {"name": "...", "description": "...",
//    "objects": [{"name": "mug", "views": [{"image": "train/mug.jpg", "background": "train/b.jpg",
//                                           "mask": .., "truth_mask": .., "yaw": 30}]}],
//    "tests": [{"image": "test/1.jpg", "group": "cluttered", "yaw": .., "roll": .., "scale": ..,
//               "occlusion": .., "objects": [{"name": "mug", "box": [x, y, w, h], "visible": 0.83,
//                                             "yaw": 75, "quad": [[x, y] x 4], "optional":
//                                             true}]}],
//    "twins": [["tea-mint", "tea-cherry"]]}
//
// Paths are relative to the folder. Coordinates are pixels of the picture as stored.
#pragma once

#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace posevote {

/// One picture to teach from. It has a background, or a mask, or neither: then the whole picture is
/// the object. Empty paths: not given.
struct DatasetView {
  std::filesystem::path image, background, mask;
  std::filesystem::path truth_mask;  ///< true silhouette; checks the segmentation, never teaches
  double yaw_deg = std::nan("");
};

struct DatasetObject {
  std::string name;
  std::vector<DatasetView> views;
};

/// One instance of an object that is in a test picture.
struct TruthObject {
  std::string name;
  cv::Rect2d box;                    ///< of the whole silhouette, px, cut to the picture
  std::vector<cv::Point2d> corners;  ///< "quad": TL, TR, BR, BL of a flat front, or empty
  double visible = 1;                ///< visible share of the silhouette, 0..1
  double yaw_deg = std::nan("");
  bool optional = false;  ///< there by accident

  /// Objects hidden for more than 85 % and optional ones are neither asked for nor wrong.
  [[nodiscard]] bool asked() const { return !optional && visible >= min_visible; }
  static constexpr double min_visible = 0.15;
};

struct DatasetTest {
  std::filesystem::path image;
  std::string group;  ///< "" when the dataset has none
  std::vector<TruthObject> objects;
  /// Values that the test varies; NaN: not given. Degrees, degrees, a factor, per cent.
  double yaw_deg = std::nan(""), roll_deg = std::nan(""), scale = std::nan(""),
         occlusion = std::nan("");
};

struct Dataset {
  std::filesystem::path folder;
  std::string name, description;
  std::vector<DatasetObject> objects;
  std::vector<DatasetTest> tests;
  std::vector<std::vector<std::string>> twins;  ///< sets of names that can hardly be told apart

  [[nodiscard]] bool are_twins(const std::string& a, const std::string& b) const;
  [[nodiscard]] std::filesystem::path path(const std::filesystem::path& relative) const {
    return folder / relative;
  }
  /// The groups in the order in which they first occur.
  [[nodiscard]] std::vector<std::string> groups() const;
};

/// Reads `path`, a dataset.json or the folder that holds one. Fields that are not known are left
/// alone. Throws Error{io} when the file cannot be read and Error{invalid_argument} when it is no
/// JSON or a field is missing, of the wrong type or out of range; the message names file and field,
/// e.g. "tests[3].objects[0].box". Pictures are not opened: see `check_dataset`.
[[nodiscard]] Dataset load_dataset(const std::filesystem::path& path);

/// The same from text; `origin` names it in messages, `folder` is what paths are relative to.
[[nodiscard]] Dataset parse_dataset(const std::string& text, const std::filesystem::path& folder,
                                    const std::string& origin);

/// Keeps the tests whose group matches one of `patterns` (shell wildcards; none: all) and then
/// at most `limit` of them (0: all), evenly spread over the dataset.
/// Throws Error{invalid_argument} when a pattern matches no group.
[[nodiscard]] Dataset select_tests(Dataset dataset, const std::vector<std::string>& patterns,
                                   int limit);

/// Matches shell wildcards `*` and `?`.
[[nodiscard]] bool matches_pattern(const std::string& text, const std::string& pattern);

}  // namespace posevote
