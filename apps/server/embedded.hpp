// Files that the build has put into the executable (cmake/PosevoteEmbed.cmake).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace posevote::server {

struct EmbeddedFile {
  std::string_view path;  ///< in its folder, with slashes
  std::string_view content;
  std::string_view hash;  ///< of the content, hex digits
};

/// The built page; empty in a build without npm.
[[nodiscard]] const std::vector<EmbeddedFile>& embedded_page();
/// openapi.yaml.
[[nodiscard]] const std::vector<EmbeddedFile>& embedded_api();

[[nodiscard]] inline std::optional<std::string> find_embedded(
    const std::vector<EmbeddedFile>& files, std::string_view path) {
  for (const EmbeddedFile& file : files)
    if (file.path == path) return std::string(file.content);
  return std::nullopt;
}

}  // namespace posevote::server
