// The HTTP server: sockets, limits and threads around one handler function.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "http/limits.hpp"
#include "http/message.hpp"
#include "http/tls.hpp"

namespace posevote::server {

/// Called from many threads at once. What it throws becomes a response (see problem.hpp).
using RequestHandler = std::function<Response(Request&)>;

class HttpServer {
 public:
  HttpServer(const Limits& limits, RequestHandler handler);
  ~HttpServer();  ///< stops

  /// Binds and begins to serve in threads of its own; port 0 takes any free one. Returns the port.
  /// With a certificate HTTPS only. Throws Error{io} with the reason when the address cannot be
  /// used.
  int start(const std::string& host, int port,
            std::unique_ptr<const Certificate> certificate = nullptr);

  /// No new connections or requests from now on; returns when the requests in hand are answered.
  void stop();

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace posevote::server
