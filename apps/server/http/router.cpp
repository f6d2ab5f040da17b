#include "http/router.hpp"

#include <sstream>

#include "http/problem.hpp"

namespace posevote::server {
namespace {

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> segments;
  std::istringstream stream(path.substr(path.starts_with('/') ? 1 : 0));
  for (std::string segment; std::getline(stream, segment, '/');) segments.push_back(segment);
  if (path.size() > 1 && path.ends_with('/')) segments.emplace_back();
  return segments;
}

bool is_parameter(const std::string& segment) {
  return segment.starts_with('{');
}

bool fits(const std::vector<std::string>& route, const std::vector<std::string>& path) {
  if (route.size() != path.size()) return false;
  for (std::size_t i = 0; i < route.size(); ++i)
    if (is_parameter(route[i]) ? path[i].empty() : route[i] != path[i]) return false;
  return true;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

std::string decode_segment(const std::string& segment) {
  std::string text;
  for (std::size_t i = 0; i < segment.size(); ++i) {
    if (segment[i] != '%') {
      text += segment[i];
      continue;
    }
    const int high = i + 2 < segment.size() ? hex_digit(segment[i + 1]) : -1;
    const int low = i + 2 < segment.size() ? hex_digit(segment[i + 2]) : -1;
    if (high < 0 || low < 0 || high + low == 0)
      throw invalid("the address is not percent-encoded as it must be");
    text += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return text;
}

void Router::add(Route route) {
  routes_.push_back(std::move(route));
}

const Route& Router::find(Request& request) const {
  const auto path = split(request.path);
  std::string methods;
  for (const Route& route : routes_) {
    const auto segments = split(route.path);
    if (!fits(segments, path)) continue;
    if (route.method != request.method) {
      methods += (methods.empty() ? "" : ", ") + route.method;
      continue;
    }
    for (std::size_t i = 0; i < segments.size(); ++i)
      if (is_parameter(segments[i]))
        request.parameters[segments[i].substr(1, segments[i].size() - 2)] = decode_segment(path[i]);
    return route;
  }
  if (methods.empty()) throw not_found("there is nothing at " + request.path);
  throw Problem(405, "method_not_allowed", "this path has the methods " + methods);
}

}  // namespace posevote::server
