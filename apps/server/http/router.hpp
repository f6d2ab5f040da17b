// Which handler answers which path and method.
#pragma once

#include <string>
#include <vector>

#include "http/message.hpp"

namespace posevote::server {

enum class Entry {
  open,       ///< for everybody
  protected_  ///< needs the token, if there is one
};

struct Route {
  std::string method;
  std::string path;  ///< as in openapi.yaml: "/api/objects/{object}/views"
  Entry entry = Entry::protected_;
  std::function<Response(Request&)> handler;
};

/// Immutable after it was filled; then safe for many threads.
class Router {
 public:
  void add(Route route);

  /// The route of `request`, whose `parameters` are set. Throws Problem 404, or 405 with the
  /// methods that the path has in its sentence.
  [[nodiscard]] const Route& find(Request& request) const;

  [[nodiscard]] const std::vector<Route>& routes() const { return routes_; }

 private:
  std::vector<Route> routes_;
};

/// Bytes for %XX. Throws Problem 400 for a % that is none, and for an encoded NUL.
[[nodiscard]] std::string decode_segment(const std::string& segment);

}  // namespace posevote::server
