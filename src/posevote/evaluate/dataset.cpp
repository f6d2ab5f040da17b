#include "posevote/evaluate/dataset.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

using nlohmann::json;

constexpr std::uintmax_t max_file_bytes = 256u << 20;

// A JSON value with the way to it, so that every message can name the place.
struct Node {
  const json* value;
  std::string origin, where;

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(ErrorCode::invalid_argument,
                origin + ": " + (where.empty() ? "the file" : where) + " " + problem);
  }
  [[nodiscard]] bool has(const char* key) const {
    return value->contains(key) && !value->at(key).is_null();
  }
  [[nodiscard]] Node at(const char* key) const {
    if (!value->is_object()) fail("must be an object {...}");
    const std::string path = where.empty() ? key : where + "." + key;
    if (!has(key)) Node{value, origin, path}.fail("is missing");
    return {&value->at(key), origin, path};
  }
  [[nodiscard]] std::vector<Node> items() const {
    if (!value->is_array()) fail("must be a list [...]");
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < value->size(); ++i)
      nodes.push_back({&(*value)[i], origin, where + "[" + std::to_string(i) + "]"});
    return nodes;
  }
  [[nodiscard]] std::string text() const {
    if (!value->is_string()) fail("must be a text");
    return value->get<std::string>();
  }
  [[nodiscard]] std::string name() const {
    std::string result = text();
    if (result.empty()) fail("must not be empty");
    return result;
  }
  [[nodiscard]] double number() const {
    if (!value->is_number()) fail("must be a number");
    const double result = value->get<double>();
    if (!std::isfinite(result)) fail("must be finite");
    return result;
  }
  [[nodiscard]] double number_or_nan(const char* key) const {
    return has(key) ? at(key).number() : std::nan("");
  }
  [[nodiscard]] std::string text_or_empty(const char* key) const {
    return has(key) ? at(key).text() : std::string();
  }
  [[nodiscard]] bool flag_or_false(const char* key) const {
    if (!has(key)) return false;
    const Node node = at(key);
    if (!node.value->is_boolean()) node.fail("must be true or false");
    return node.value->get<bool>();
  }
};

cv::Point2d read_point(const Node& node) {
  const auto xy = node.items();
  if (xy.size() != 2) node.fail("must be a point [x, y]");
  return {xy[0].number(), xy[1].number()};
}

cv::Rect2d read_box(const Node& node) {
  const auto items = node.items();
  if (items.size() != 4) node.fail("must be a box [x, y, width, height]");
  const cv::Rect2d box(items[0].number(), items[1].number(), items[2].number(), items[3].number());
  if (box.width < 0 || box.height < 0) node.fail("must not have a negative width or height");
  return box;
}

DatasetView read_view(const Node& node) {
  DatasetView view;
  view.image = node.at("image").name();
  view.background = node.text_or_empty("background");
  view.mask = node.text_or_empty("mask");
  view.truth_mask = node.text_or_empty("truth_mask");
  view.yaw_deg = node.number_or_nan("yaw");
  if (!view.background.empty() && !view.mask.empty())
    node.fail("has both a background and a mask; keep the one that shall be used");
  return view;
}

std::vector<DatasetObject> read_objects(const Node& list) {
  std::vector<DatasetObject> objects;
  for (const Node& node : list.items()) {
    DatasetObject object{node.at("name").name(), {}};
    if (std::ranges::count(objects, object.name, &DatasetObject::name))
      node.fail("has the name '" + object.name + "', which an object before it has already");
    for (const Node& view : node.at("views").items()) object.views.push_back(read_view(view));
    objects.push_back(std::move(object));
  }
  return objects;
}

TruthObject read_truth(const Node& node) {
  TruthObject truth;
  truth.name = node.at("name").name();
  truth.box = read_box(node.at("box"));
  if (node.has("quad")) {
    for (const Node& corner : node.at("quad").items()) truth.corners.push_back(read_point(corner));
    if (truth.corners.size() != 4) node.at("quad").fail("must have four points: TL, TR, BR, BL");
  }
  if (node.has("visible")) {
    truth.visible = node.at("visible").number();
    if (truth.visible < 0 || truth.visible > 1) node.at("visible").fail("must lie in 0..1");
  }
  truth.yaw_deg = node.number_or_nan("yaw");
  truth.optional = node.flag_or_false("optional");
  return truth;
}

std::vector<DatasetTest> read_tests(const Node& list) {
  std::vector<DatasetTest> tests;
  for (const Node& node : list.items()) {
    DatasetTest test;
    test.image = node.at("image").name();
    test.group = node.text_or_empty("group");
    for (const Node& truth : node.at("objects").items()) test.objects.push_back(read_truth(truth));
    test.yaw_deg = node.number_or_nan("yaw");
    test.roll_deg = node.number_or_nan("roll");
    test.scale = node.number_or_nan("scale");
    test.occlusion = node.number_or_nan("occlusion");
    tests.push_back(std::move(test));
  }
  return tests;
}

std::vector<std::vector<std::string>> read_twins(const Node& list) {
  std::vector<std::vector<std::string>> twins;
  for (const Node& node : list.items()) {
    std::vector<std::string> names;
    for (const Node& name : node.items()) names.push_back(name.name());
    if (names.size() < 2) node.fail("must hold at least two names");
    twins.push_back(std::move(names));
  }
  return twins;
}

std::string read_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream)
    throw Error(ErrorCode::io, "cannot read " + file.string() +
                                   "; a dataset is a folder with a file dataset.json");
  if (size > max_file_bytes)
    throw Error(ErrorCode::io, file.string() + " is too large for a dataset.json");
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

bool Dataset::are_twins(const std::string& a, const std::string& b) const {
  return a != b && std::ranges::any_of(twins, [&](const auto& names) {
           return std::ranges::count(names, a) != 0 && std::ranges::count(names, b) != 0;
         });
}

std::vector<std::string> Dataset::groups() const {
  std::vector<std::string> names;
  for (const DatasetTest& test : tests)
    if (!std::ranges::count(names, test.group)) names.push_back(test.group);
  return names;
}

Dataset parse_dataset(const std::string& text, const std::filesystem::path& folder,
                      const std::string& origin) {
  json document;
  try {
    document = json::parse(text);
  } catch (const json::parse_error& error) {
    throw Error(ErrorCode::invalid_argument,
                origin + " is not valid JSON near byte " + std::to_string(error.byte));
  }
  const Node root{&document, origin, ""};
  Dataset dataset;
  dataset.folder = folder;
  dataset.objects = read_objects(root.at("objects"));
  dataset.tests = read_tests(root.at("tests"));
  if (root.has("twins")) dataset.twins = read_twins(root.at("twins"));
  dataset.name = root.text_or_empty("name");
  if (dataset.name.empty()) dataset.name = folder.filename().string();
  dataset.description = root.text_or_empty("description");
  return dataset;
}

Dataset load_dataset(const std::filesystem::path& path) {
  const bool is_folder = std::filesystem::is_directory(path);
  const std::filesystem::path file = is_folder ? path / "dataset.json" : path;
  const std::filesystem::path folder = is_folder ? path : path.parent_path();
  return parse_dataset(read_file(file), folder.lexically_normal(), file.string());
}

bool matches_pattern(const std::string& text, const std::string& pattern) {
  // Greedy matching with one point of return: the last star.
  std::size_t t = 0, p = 0, star = std::string::npos, resume = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string::npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string::npos;
}

Dataset select_tests(Dataset dataset, const std::vector<std::string>& patterns, int limit) {
  const auto groups = dataset.groups();
  for (const std::string& pattern : patterns)
    if (std::ranges::none_of(groups, [&](auto& g) { return matches_pattern(g, pattern); }))
      throw Error(ErrorCode::invalid_argument,
                  "dataset " + dataset.name + " has no group like '" + pattern + "'");
  if (!patterns.empty())
    std::erase_if(dataset.tests, [&](const DatasetTest& test) {
      return std::ranges::none_of(patterns, [&](const std::string& pattern) {
        return matches_pattern(test.group, pattern);
      });
    });
  const std::size_t count = dataset.tests.size();
  const auto wanted = static_cast<std::size_t>(std::max(limit, 0));
  if (wanted == 0 || wanted >= count) return dataset;
  std::vector<DatasetTest> kept;
  for (std::size_t i = 0; i < wanted; ++i) kept.push_back(dataset.tests[i * count / wanted]);
  dataset.tests = std::move(kept);
  return dataset;
}

}  // namespace posevote
