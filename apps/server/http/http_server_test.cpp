#include "http/http_server.hpp"

#include <gmock/gmock.h>
#include <httplib.h>

#include <latch>
#include <thread>

namespace posevote::server {
namespace {

httplib::Client client_of(int port) {
  httplib::Client client("127.0.0.1", port);
  client.set_read_timeout(std::chrono::minutes(5));
  return client;
}

TEST(HttpServer, BodiesCountUntilTheirRequestsAreAnswered) {
  Limits limits;
  limits.bodies_mb = 1;
  std::latch arrived(1), let_go(1);
  HttpServer server(limits, [&](Request& request) {
    const Body body = request.read_body(10'000'000);
    if (request.path == "/waits") {
      arrived.count_down();
      let_go.wait();
    }
    return no_content();
  });
  const int port = server.start("127.0.0.1", 0);
  const std::string most(700'000, 'x');
  const auto status = [&](const char* path) {
    const auto result = client_of(port).Post(path, most, "image/jpeg");
    return result ? result->status : 0;
  };
  std::jthread waiting([&] { EXPECT_EQ(status("/waits"), 204); });
  arrived.wait();
  EXPECT_EQ(status("/"), 503) << "its body is still in memory";
  let_go.count_down();
  waiting.join();
  EXPECT_EQ(status("/"), 204);
}

}  // namespace
}  // namespace posevote::server
