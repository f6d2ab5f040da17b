// Who may do what; what a hostile client can send.
#include <sys/socket.h>
#include <unistd.h>

#include <opencv2/imgcodecs.hpp>

#include "server_process.hpp"

namespace posevote {
namespace {

constexpr const char* kToken = "a token of some length";

class AccessTest : public ServerTest {
 protected:
  /// Bytes as they are, and what comes back until the server closes.
  std::string raw(const std::string& request) {
    const int socket = open_socket();
    send(socket, request.data(), request.size(), MSG_NOSIGNAL);
    std::string answer;
    char buffer[4096];
    for (ssize_t got; (got = recv(socket, buffer, sizeof buffer, 0)) > 0;)
      answer.append(buffer, static_cast<std::size_t>(got));
    close(socket);
    return answer;
  }

  /// Is this in the answer? The time for a request may also pass because the machine is busy, so it
  /// is sent again.
  bool answers(const std::string& request, const std::string& what) {
    return eventually([&] { return raw(request).find(what) != std::string::npos; });
  }

  int status(const std::string& path, const httplib::Headers& headers) {
    const auto result = client().Get(path, headers);
    return result ? result->status : 0;
  }
};

TEST_F(AccessTest, TheTokenOpensByHeaderAndByCookie) {
  start({}, {{"POSEVOTE_TOKEN", kToken}});
  EXPECT_EQ(status("/api/objects", {}), 401);
  EXPECT_EQ(status("/api/objects", {{"Authorization", std::string("Bearer ") + kToken}}), 200);
  EXPECT_EQ(status("/api/objects", {{"Authorization", std::string("Basic ") + kToken}}), 401);
  EXPECT_EQ(get("/api/session")["authenticated"], false);
  const auto login =
      client().Post("/api/login", Json{{"token", kToken}}.dump(), "application/json");
  const std::string cookie = login->get_header_value("Set-Cookie");
  EXPECT_NE(cookie.find("HttpOnly"), std::string::npos);
  EXPECT_NE(cookie.find("SameSite=Strict"), std::string::npos);
  EXPECT_EQ(cookie.find(kToken), std::string::npos)
      << "the token itself is not kept in the browser";
  const std::string pair = cookie.substr(0, cookie.find(';'));
  EXPECT_EQ(status("/api/objects", {{"Cookie", "a=b; " + pair}}), 200);
  EXPECT_EQ(status("/api/objects", {{"Cookie", pair + "0"}}), 401);
  EXPECT_EQ(status("/api/objects", {{"Cookie", "posevote="}}), 401);
  EXPECT_EQ(status("/api/health", {}), 200) << "for watchdogs";
  EXPECT_EQ(status("/", {}), 200) << "the page asks for the token itself";
}

TEST_F(AccessTest, OnlyThisServersNamesWithoutAToken) {
  start({"--host", "robot.local"});
  const auto with_host = [&](const std::string& host) {
    return status("/api/objects", {{"Host", host}});
  };
  EXPECT_EQ(with_host("localhost:80"), 200);
  EXPECT_EQ(with_host("[::1]:80"), 200);
  EXPECT_EQ(with_host("Robot.local:80"), 200);
  EXPECT_EQ(with_host("evil.example"), 403) << "a page elsewhere may point its name here";
  EXPECT_EQ(with_host("127.0.0.1.evil.example"), 403);
}

TEST_F(AccessTest, ChangesFromOtherSitesAreRefused) {
  start();
  const std::string own = "http://127.0.0.1:" + std::to_string(server_->port());
  const auto post = [&](const httplib::Headers& headers) {
    const auto result = client().Post("/api/teach-sessions", headers, "", "text/plain");
    return result ? result->status : 0;
  };
  EXPECT_EQ(post({}), 201) << "programs send no Origin";
  EXPECT_EQ(post({{"Origin", own}}), 201);
  EXPECT_EQ(post({{"Origin", "null"}}), 403);
  EXPECT_EQ(post({{"Origin", "http://127.0.0.1:1"}}), 403);
  EXPECT_EQ(post({{"Sec-Fetch-Site", "cross-site"}}), 403);
  EXPECT_EQ(post({{"Sec-Fetch-Site", "same-origin"}}), 201);
}

TEST_F(AccessTest, EveryResponseTellsTheBrowserToBeCareful) {
  start();
  for (const char* path : {"/", "/api/health", "/api/nothing"}) {
    const auto result = client().Get(path);
    EXPECT_NE(result->get_header_value("Content-Security-Policy").find("default-src 'none'"),
              std::string::npos);
    EXPECT_EQ(result->get_header_value("X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(result->get_header_value("X-Frame-Options"), "DENY");
  }
}

TEST_F(AccessTest, NoFileOfTheMachineIsServed) {
  start();
  for (const std::string path :
       {"/../../../../etc/passwd", "/..%2f..%2f..%2fetc/passwd", "/%2e%2e/%2e%2e/etc/passwd",
        "/./../etc/passwd", "//etc/passwd", "/api/objects/..%2F..%2Fetc%2Fpasswd",
        "/api/undo/..%2F..%2Flock", "/api/teach-sessions/..%2F..%2Fx", "/page/%00"}) {
    const std::string answer =
        raw("GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    EXPECT_EQ(answer.find("root:"), std::string::npos) << path;
    EXPECT_NE(answer.find("HTTP/1.1 40"), std::string::npos) << path << "\n" << answer;
  }
}

TEST_F(AccessTest, RequestsThatAreNoneGetAnAnswerOrAnEnd) {
  start({"--set", "limits.request_s=1"});
  EXPECT_TRUE(answers("nonsense\r\n\r\n", "400"));
  EXPECT_EQ(raw("GET / HTTP/1.1\r\n").find("200"), std::string::npos) << "the head never ends";
  raw("GET / HTTP/1.1\r\nX: " + std::string(100'000, 'x'));
  raw(std::string(100'000, 'x'));
  const std::string post = "POST /api/recognize HTTP/1.1\r\nHost: localhost\r\nContent-Length: ";
  EXPECT_TRUE(answers(post + "100\r\n\r\nabc", "408"));
  EXPECT_TRUE(answers(post + "99999999999999\r\nConnection: close\r\n\r\nabc", "413"));
  EXPECT_TRUE(answers("GET /api/health HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
                      "\"ok\""));
}

TEST_F(AccessTest, ABodyThatGrowsWithoutALengthIsCutOff) {
  start({"--set", "limits.body_mb=0.1"});
  std::string body;
  for (int i = 0; i < 40; ++i) body += "4000\r\n" + std::string(0x4000, 'x') + "\r\n";
  const std::string answer =
      raw("POST /api/recognize HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n" +
          body);
  EXPECT_NE(answer.find("413"), std::string::npos) << answer;
}

TEST_F(AccessTest, ACompressedBodyIsRefused) {
  start();
  const auto result = client().Post("/api/recognize", {{"Content-Encoding", "gzip"}},
                                    std::string(100, '\0'), "image/jpeg");
  EXPECT_EQ(result->status, 400);
}

TEST_F(AccessTest, PicturesAreBoundedBeforeTheyAreDecoded) {
  start({"--set", "limits.megapixels=0.5"});
  const auto status = [&](const std::string& body) {
    return client().Post("/api/recognize", body, "image/png")->status;
  };
  std::vector<std::uint8_t> data;
  cv::imencode(".png", cv::Mat::zeros(1000, 1000, CV_8U), data);
  EXPECT_EQ(status({data.begin(), data.end()}), 422);
  cv::imencode(".png", cv::Mat::zeros(4, 4, CV_8U), data);
  const std::vector<std::uint8_t> huge{0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60};  // 60000 x 60000
  std::copy(huge.begin(), huge.end(), data.begin() + 16);
  EXPECT_EQ(status({data.begin(), data.end()}), 422);
  const std::string picture = content(demo("train/poster/cover.jpg"));
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, picture.size() / 2})
    EXPECT_EQ(status(picture.substr(0, size)), 422) << size;
}

TEST_F(AccessTest, OtherAddressesDemandAToken) {
  EXPECT_THROW(start({"--listen", "0.0.0.0:0"}), std::runtime_error);
  EXPECT_NE(content(folder_ + "/err.txt").find("token"), std::string::npos);
  EXPECT_THROW(start({"--listen", "0.0.0.0:0"}, {{"POSEVOTE_TOKEN", "short"}}), std::runtime_error);
}

TEST_F(AccessTest, OneServerForOneDatabase) {
  start();
  EXPECT_THROW(ServerProcess(folder_, {}), std::runtime_error);
  EXPECT_NE(content(folder_ + "/err.txt").find("another posevote serve"), std::string::npos);
}

}  // namespace
}  // namespace posevote
