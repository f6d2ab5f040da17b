// posevote serve: the studio behind HTTP.
#pragma once

#include <memory>
#include <string>

#include "http/http_server.hpp"
#include "http/router.hpp"
#include "studio/studio.hpp"

namespace posevote::server {

class Server {
 public:
  explicit Server(StudioConfig config);
  ~Server();

  /// See HttpServer::start.
  int start(const std::string& host, int port,
            std::unique_ptr<const Certificate> certificate = nullptr);
  /// Answers what is in hand, then ends.
  void stop();

  [[nodiscard]] const std::vector<Route>& routes() const { return router_.routes(); }

 private:
  Response answer(Request& request);

  Studio studio_;
  Router router_;
  HttpServer http_;
};

}  // namespace posevote::server
