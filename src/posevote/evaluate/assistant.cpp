#include "posevote/evaluate/assistant.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "posevote/core/error.hpp"
#include "posevote/image/read_image.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

bool is_picture(const fs::path& path) {
  static const char* const endings[] = {".jpg", ".jpeg", ".png", ".tif", ".tiff",
                                        ".bmp", ".webp", ".ppm", ".pgm"};
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return fs::is_regular_file(path) && std::ranges::count(endings, ending) != 0;
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> paths;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder)) paths.push_back(entry.path());
  std::ranges::sort(paths);
  return paths;
}

std::string without_mask_ending(const std::string& stem) {
  for (const char* ending : {"-mask", "_mask", ".mask"})
    if (stem.ends_with(ending)) return stem.substr(0, stem.size() - std::string(ending).size());
  return "";
}

// The number after "y" or "yaw" at the end of a file's name.
std::optional<double> yaw_of(const std::string& stem) {
  const auto digits = stem.find_last_not_of("0123456789.") + 1;
  if (digits == stem.size() || digits == 0) return std::nullopt;
  const bool negative = stem[digits - 1] == '-';
  const std::string before = stem.substr(0, digits - (negative ? 1 : 0));
  const bool long_form = before.ends_with("yaw");
  const std::size_t letters = long_form ? 3 : before.ends_with("y") ? 1 : 0;
  if (letters == 0) return std::nullopt;
  // A word that happens to end with y, e.g. "ivy2", is no turn.
  if (before.size() > letters &&
      std::isalnum(static_cast<unsigned char>(before[before.size() - letters - 1])))
    return std::nullopt;
  double value = 0;
  const char* end = stem.data() + stem.size();
  if (std::from_chars(stem.data() + digits, end, value).ptr != end) return std::nullopt;
  return negative ? -value : value;
}

ordered_json views_in(const fs::path& folder, const fs::path& root) {
  std::map<std::string, fs::path> masks;
  fs::path background;
  std::vector<fs::path> pictures;
  for (const fs::path& path : sorted_entries(folder)) {
    if (!is_picture(path)) continue;
    const std::string stem = path.stem().string(), owner = without_mask_ending(stem);
    if (!owner.empty())
      masks[owner] = path;
    else if (stem == "background")
      background = path;
    else
      pictures.push_back(path);
  }
  ordered_json views = ordered_json::array();
  for (const fs::path& picture : pictures) {
    const auto relative = [&](const fs::path& path) {
      return path.lexically_relative(root).generic_string();
    };
    ordered_json view{{"image", relative(picture)}};
    const auto mask = masks.find(picture.stem().string());
    if (mask != masks.end())
      view["mask"] = relative(mask->second);
    else if (!background.empty())
      view["background"] = relative(background);
    if (const auto yaw = yaw_of(picture.stem().string())) view["yaw"] = *yaw;
    views.push_back(std::move(view));
  }
  return views;
}

void add_tests_in(const fs::path& folder, const fs::path& root, ordered_json& tests) {
  for (const fs::path& path : sorted_entries(folder)) {
    if (fs::is_directory(path)) add_tests_in(path, root, tests);
    if (!is_picture(path)) continue;
    ordered_json test{{"image", path.lexically_relative(root).generic_string()}};
    const std::string group = folder.lexically_relative(root / "test").generic_string();
    if (group != ".") test["group"] = group;
    test["objects"] = ordered_json::array();
    tests.push_back(std::move(test));
  }
}

ordered_json truth_json(const TruthObject& truth) {
  ordered_json json{{"name", truth.name},
                    {"box", {truth.box.x, truth.box.y, truth.box.width, truth.box.height}}};
  if (truth.visible < 1) json["visible"] = truth.visible;
  if (!std::isnan(truth.yaw_deg)) json["yaw"] = truth.yaw_deg;
  if (truth.optional) json["optional"] = true;
  return json;
}

}  // namespace

std::string make_dataset(const std::filesystem::path& folder) {
  if (!fs::is_directory(folder / "train") && !fs::is_directory(folder / "test"))
    throw Error(ErrorCode::not_found,
                folder.string() + " has neither a folder train (train/NAME/PICTURE) nor test");
  fs::path named = fs::absolute(folder).lexically_normal();
  if (!named.has_filename()) named = named.parent_path();  // a path that ends with a slash
  ordered_json document{{"name", named.filename().string()},
                        {"description", ""},
                        {"objects", ordered_json::array()},
                        {"tests", ordered_json::array()}};
  for (const fs::path& path : sorted_entries(folder / "train"))
    if (fs::is_directory(path))
      document["objects"].push_back(
          {{"name", path.filename().string()}, {"views", views_in(path, folder)}});
  add_tests_in(folder / "test", folder, document["tests"]);
  return document.dump(2) + "\n";
}

std::filesystem::path dataset_file(const std::filesystem::path& path) {
  return fs::is_directory(path) ? path / "dataset.json" : path;
}

std::string add_to_dataset(const std::filesystem::path& path, const DatasetAddition& addition) {
  static_cast<void>(load_dataset(path));  // says what is wrong with the file, if anything is
  const auto bytes = read_bytes(dataset_file(path).string());
  ordered_json document = ordered_json::parse(bytes);
  ordered_json& tests = document["tests"];
  auto found = std::ranges::find_if(tests, [&](auto& t) { return t["image"] == addition.image; });
  if (found == tests.end()) {
    tests.push_back({{"image", addition.image}, {"objects", ordered_json::array()}});
    found = std::prev(tests.end());
  }
  if (!addition.group.empty()) (*found)["group"] = addition.group;
  for (const TruthObject& truth : addition.objects)
    (*found)["objects"].push_back(truth_json(truth));
  return document.dump(2) + "\n";
}

TruthObject parse_truth(const std::string& text) {
  const auto fail = [&] {
    throw Error(ErrorCode::invalid_argument,
                "an object in a picture is NAME=X,Y,WIDTH,HEIGHT, not '" + text + "'");
  };
  const auto equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) fail();
  double values[4] = {};
  const char* at = text.data() + equals + 1;
  const char* const end = text.data() + text.size();
  for (int i = 0; i < 4; ++i) {
    const auto [stop, error] = std::from_chars(at, end, values[i]);
    if (error != std::errc() || !std::isfinite(values[i])) fail();
    if (i < 3 && (stop == end || *stop != ',')) fail();
    if (i == 3 && stop != end) fail();
    at = stop + 1;
  }
  if (values[2] <= 0 || values[3] <= 0) fail();
  TruthObject truth;
  truth.name = text.substr(0, equals);
  truth.box = {values[0], values[1], values[2], values[3]};
  return truth;
}

void replace_file(const std::filesystem::path& file, const std::string& text) {
  const fs::path temporary = file.string() + ".new";
  std::ofstream stream(temporary, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code error;
  if (stream) fs::rename(temporary, file, error);
  if (!stream || error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw Error(ErrorCode::io, "cannot write " + file.string());
  }
}

}  // namespace posevote
