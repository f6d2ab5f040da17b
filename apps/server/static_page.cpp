#include "static_page.hpp"

#include <algorithm>
#include <array>

#include "http/problem.hpp"

namespace posevote::server {
namespace {

std::string type_of(std::string_view path) {
  constexpr std::array<std::pair<std::string_view, const char*>, 12> types{{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".txt", "text/plain; charset=utf-8"},
      {".yaml", "application/yaml"},
  }};
  for (const auto& [ending, type] : types)
    if (path.ends_with(ending)) return type;
  return "application/octet-stream";
}

}  // namespace

Response page_response(const Request& request, const std::vector<EmbeddedFile>& files) {
  const std::string path = request.path == "/" ? "index.html" : request.path.substr(1);
  Response response;
  if (files.empty() && request.path == "/") {
    response.type = "text/plain; charset=utf-8";
    response.body =
        "This build of posevote holds no page, because npm was not there when it was built; its "
        "HTTP interface works: /api/openapi.yaml describes it.\n";
    return response;
  }
  const auto file = std::ranges::find(files, path, &EmbeddedFile::path);
  if (file == files.end()) throw not_found("there is nothing at " + request.path);
  const std::string tag = '"' + std::string(file->hash) + '"';
  response.headers.emplace("ETag", tag);
  response.headers.emplace("Cache-Control", "no-cache");
  if (request.header("If-None-Match") == tag) {
    response.status = 304;
    return response;
  }
  response.type = type_of(path);
  response.body = file->content;
  return response;
}

}  // namespace posevote::server
