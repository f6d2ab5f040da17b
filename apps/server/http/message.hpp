// Requests and responses as the rest of the server sees them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace posevote::server {

using Bytes = std::vector<std::uint8_t>;

/// A request body in memory: raw, or the parts of multipart/form-data by name.
struct Body {
  Bytes raw;
  std::map<std::string, Bytes> parts;
  std::shared_ptr<const void> share;  ///< of limits.bodies_mb, free again when the body is gone
  [[nodiscard]] bool empty() const { return raw.empty() && parts.empty(); }
};

/// Handed to the handler while it runs; not to be kept.
struct Request {
  std::string method;
  std::string path;                                ///< as sent, without the query
  std::map<std::string, std::string> parameters;   ///< those in the path, decoded
  std::multimap<std::string, std::string> query;   ///< decoded
  std::function<std::string(const char*)> header;  ///< "" when it is not there
  /// Reads the body, at most `max_bytes`; throws Problem 413, 408, 400. Once only.
  std::function<Body(std::size_t max_bytes)> read_body;
  /// Reads a raw body piece by piece, the same way.
  std::function<void(std::size_t max_bytes, const std::function<void(const char*, std::size_t)>&)>
      receive_body;

  [[nodiscard]] std::optional<std::string> find(const std::string& query_name) const {
    const auto at = query.find(query_name);
    return at == query.end() ? std::nullopt : std::optional(at->second);
  }
  [[nodiscard]] const std::string& operator[](const char* parameter) const {
    return parameters.at(parameter);
  }
};

/// Writes to the client; false: it is gone, or too slow.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual bool write(const std::string& data) = 0;
  /// The client has left, or the server is being stopped.
  [[nodiscard]] virtual bool closed() = 0;
};

struct Response {
  int status = 200;
  std::string type;
  std::string body;
  std::multimap<std::string, std::string> headers;
  /// Instead of a body: writes until it returns or the sink is closed.
  std::function<void(Sink&)> stream;
};

[[nodiscard]] inline Response bytes_response(const std::string& type, const Bytes& data) {
  Response response;
  response.type = type;
  response.body.assign(data.begin(), data.end());
  return response;
}

[[nodiscard]] inline Response no_content() {
  Response response;
  response.status = 204;
  return response;
}

}  // namespace posevote::server
