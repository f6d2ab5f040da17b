#include "posevote/image/inputs.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <set>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;

const std::set<std::string> image_endings{".jpg", ".jpeg", ".png", ".tif", ".tiff", ".webp",
                                          ".bmp", ".pbm",  ".pgm", ".ppm", ".pnm"};
const std::set<std::string> video_endings{".avi",  ".mp4", ".m4v",  ".mov",  ".mkv",
                                          ".webm", ".mpg", ".ogv",  ".wmv",  ".mpeg",
                                          ".flv",  ".3gp", ".mjpg", ".mjpeg"};

std::string ending(const fs::path& path) {
  std::string text = path.extension().string();
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

Input camera_input(const std::string& argument, const std::string& number) {
  int camera = -1;
  const char* end = number.data() + number.size();
  const auto [stop, error] = std::from_chars(number.data(), end, camera);
  if (error != std::errc() || stop != end || camera < 0)
    throw Error(ErrorCode::invalid_argument,
                "'" + argument + "' names no camera; write camera:0 for the first one");
  return {InputKind::camera, argument, camera};
}

std::vector<Input> folder_inputs(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> paths;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (image_endings.contains(ending(entry->path())) && !entry->is_directory(error))
      paths.push_back((fs::path(folder) / entry->path().filename()).string());
  if (error)
    throw Error(ErrorCode::unreadable_image,
                "cannot read folder '" + folder + "': " + error.message());
  if (paths.empty()) throw Error(ErrorCode::not_found, "folder '" + folder + "' holds no pictures");
  std::ranges::sort(paths);
  std::vector<Input> inputs;
  inputs.reserve(paths.size());
  for (std::string& path : paths) inputs.push_back({InputKind::image, std::move(path), -1});
  return inputs;
}

}  // namespace

std::vector<Input> expand_input(const std::string& argument) {
  const std::string camera = "camera:";
  if (argument.starts_with(camera)) return {camera_input(argument, argument.substr(camera.size()))};
  std::error_code ignored;
  if (fs::is_directory(argument, ignored)) return folder_inputs(argument);
  if (video_endings.contains(ending(argument))) return {{InputKind::video, argument, -1}};
  return {{InputKind::image, argument, -1}};
}

}  // namespace posevote
