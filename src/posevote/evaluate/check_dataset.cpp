#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "posevote/core/error.hpp"
#include "posevote/core/options.hpp"
#include "posevote/evaluate/assistant.hpp"
#include "posevote/evaluate/evaluator.hpp"
#include "posevote/image/read_image.hpp"

namespace posevote {
namespace {

class Checker {
 public:
  explicit Checker(const Dataset& dataset) : dataset_(dataset) {
    for (const DatasetObject& object : dataset.objects) names_.push_back(object.name);
  }

  std::vector<DatasetProblem> check() {
    for (std::size_t i = 0; i < dataset_.objects.size(); ++i) check_object(i);
    for (std::size_t i = 0; i < dataset_.tests.size(); ++i) check_test(i);
    check_names();
    return std::move(problems_);
  }

 private:
  void error(const std::string& where, const std::string& what) {
    problems_.push_back({true, where, what});
  }
  void hint(const std::string& where, const std::string& what) {
    problems_.push_back({false, where, what});
  }

  // The size of a picture; empty when it cannot be read, which is noted once.
  cv::Size size_of(const std::filesystem::path& relative, const std::string& where) {
    const std::string key = relative.generic_string();
    const auto known = sizes_.find(key);
    if (known != sizes_.end()) return known->second;
    cv::Size size;
    try {
      const cv::Mat as_stored = read_dataset_image(dataset_, relative);
      size = as_stored.size();
      const cv::Mat upright = read_image(dataset_.path(relative).string());
      if (upright.size() != size || cv::norm(upright, as_stored, cv::NORM_INF) > 0)
        hint(where, key + " has an Exif orientation, which is not applied: save it upright");
    } catch (const Error& problem) {
      error(where, problem.what());
    }
    return sizes_[key] = size;
  }

  void check_companion(const std::filesystem::path& companion, const std::string& where,
                       cv::Size size) {
    if (companion.empty()) return;
    const cv::Size other = size_of(companion, where);
    if (!other.empty() && !size.empty() && other != size)
      error(where, companion.generic_string() + " is " + text(other) + ", the view's picture " +
                       text(size));
  }

  void check_object(std::size_t index) {
    const DatasetObject& object = dataset_.objects[index];
    const std::string where = "objects[" + std::to_string(index) + "]";
    if (object.views.empty()) error(where, "'" + object.name + "' has no view");
    for (std::size_t i = 0; i < object.views.size(); ++i) {
      const DatasetView& view = object.views[i];
      const std::string place = where + ".views[" + std::to_string(i) + "]";
      const cv::Size size = size_of(view.image, place + ".image");
      check_companion(view.background, place + ".background", size);
      check_companion(view.mask, place + ".mask", size);
      check_companion(view.truth_mask, place + ".truth_mask", size);
      taught_.insert(view.image.generic_string());
    }
  }

  void check_test(std::size_t index) {
    const DatasetTest& test = dataset_.tests[index];
    const std::string where = "tests[" + std::to_string(index) + "]";
    const std::string key = test.image.generic_string();
    if (!tested_.insert(key).second) hint(where, key + " is a test twice");
    if (taught_.contains(key)) hint(where, key + " is taught too: the test is too easy");
    const cv::Size size = size_of(test.image, where + ".image");
    for (std::size_t i = 0; i < test.objects.size(); ++i)
      check_truth(test.objects[i], where + ".objects[" + std::to_string(i) + "]", size);
  }

  void check_truth(const TruthObject& truth, const std::string& where, cv::Size size) {
    if (truth.asked()) asked_.insert(truth.name);
    if (std::ranges::count(names_, truth.name) == 0) {
      const std::string nearest = nearest_word(truth.name, names_);
      error(where + ".name", "'" + truth.name + "' is never taught" +
                                 (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
    }
    if (truth.box.area() <= 0) error(where + ".box", "covers nothing");
    if (size.empty()) return;
    const cv::Rect2d picture(0, 0, size.width, size.height);
    if ((truth.box & picture).area() <= 0)
      error(where + ".box", "lies outside the picture, which is " + text(size));
    else if ((truth.box & picture).area() < 0.99 * truth.box.area())
      hint(where + ".box",
           "reaches beyond the picture, which is " + text(size) + ": boxes are cut to it");
  }

  void check_names() {
    for (const std::string& name : names_)
      if (!asked_.contains(name)) hint("objects", "'" + name + "' is never asked for");
    for (const auto& twins : dataset_.twins)
      for (const std::string& name : twins)
        if (std::ranges::count(names_, name) == 0)
          hint("twins", "'" + name + "' is no object of this data set");
  }

  static std::string text(cv::Size size) {
    return std::to_string(size.width) + "x" + std::to_string(size.height);
  }

  const Dataset& dataset_;
  std::vector<DatasetProblem> problems_;
  std::vector<std::string> names_;
  std::map<std::string, cv::Size> sizes_;
  std::set<std::string> taught_, tested_, asked_;
};

using Keys = std::vector<std::string>;

void check_keys(const nlohmann::json& object, const Keys& known, const std::string& where,
                std::vector<DatasetProblem>& problems) {
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::count(known, key)) continue;
    const std::string nearest = nearest_word(key, known);
    problems.push_back({false, where,
                        "field '" + key + "' is not known" +
                            (nearest.empty() ? "" : "; did you mean '" + nearest + "'?")});
  }
}

void check_fields(const nlohmann::json& document, std::vector<DatasetProblem>& problems) {
  check_keys(document, {"name", "description", "objects", "tests", "twins"}, "", problems);
  for (std::size_t i = 0; i < document["objects"].size(); ++i) {
    const auto& object = document["objects"][i];
    const std::string where = "objects[" + std::to_string(i) + "]";
    check_keys(object, {"name", "views"}, where, problems);
    for (std::size_t v = 0; v < object["views"].size(); ++v)
      check_keys(object["views"][v], {"image", "background", "mask", "truth_mask", "yaw"},
                 where + ".views[" + std::to_string(v) + "]", problems);
  }
  for (std::size_t i = 0; i < document["tests"].size(); ++i) {
    const auto& test = document["tests"][i];
    const std::string where = "tests[" + std::to_string(i) + "]";
    check_keys(test, {"image", "group", "objects", "yaw", "roll", "scale", "occlusion"}, where,
               problems);
    for (std::size_t o = 0; o < test["objects"].size(); ++o)
      check_keys(test["objects"][o], {"name", "box", "visible", "yaw", "quad", "optional"},
                 where + ".objects[" + std::to_string(o) + "]", problems);
  }
}

}  // namespace

std::vector<DatasetProblem> check_dataset(const std::filesystem::path& path) {
  const Dataset dataset = load_dataset(path);
  auto problems = Checker(dataset).check();
  check_fields(nlohmann::json::parse(read_bytes(dataset_file(path).string())), problems);
  return problems;
}

}  // namespace posevote
