// HTTPS, and what else may come to its port.
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>

#include "server_process.hpp"

namespace posevote {
namespace {

class TlsTest : public ServerTest {
 protected:
  void SetUp() override { make_certificate("cert.pem", "key.pem"); }

  /// As docs/server.md says.
  void make_certificate(const std::string& certificate, const std::string& key) {
    const std::string command =
        "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 365"
        " -subj /CN=robot -addext subjectAltName=DNS:robot.local,IP:127.0.0.1"
        " -addext extendedKeyUsage=serverAuth -keyout " +
        path(key) + " -out " + path(certificate) + " 2> /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0) << "is openssl installed?";
  }

  void start_tls(std::vector<std::string> arguments = {},
                 const std::map<std::string, std::string>& environment = {}) {
    arguments.insert(arguments.end(),
                     {"--tls-cert", path("cert.pem"), "--tls-key", path("key.pem")});
    start(arguments, environment);
    signal(SIGPIPE, SIG_IGN);  // not for the server: clients write to what it may have closed
  }

  /// A connection that has sent these bytes.
  int connection(const std::string& bytes) {
    const int socket = open_socket();
    EXPECT_EQ(send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
    return socket;
  }

  /// What comes until the server closes; "reset" is added when it did not do so in order.
  static std::string rest_of(int socket) {
    std::string answer;
    char buffer[4096];
    ssize_t got = 0;
    while ((got = recv(socket, buffer, sizeof buffer, 0)) > 0)
      answer.append(buffer, static_cast<std::size_t>(got));
    close(socket);
    return got < 0 ? answer + "reset" : answer;
  }

  /// Expects that the server does not begin, says a sentence with `words` and exits with `status`.
  void expect_refusal(const std::vector<std::string>& arguments, int status,
                      const std::string& words) {
    std::string command =
        std::string(POSEVOTE_PROGRAM) + " serve --listen 127.0.0.1:0 --db " + path("objects.db");
    for (const std::string& argument : arguments) command.append(" '").append(argument).append("'");
    const int ended = std::system((command + " 2> " + path("err.txt")).c_str());
    EXPECT_EQ(WEXITSTATUS(ended), status) << command;
    const std::string said = content(path("err.txt"));
    EXPECT_THAT(said, testing::HasSubstr(words));
    EXPECT_EQ(std::ranges::count(said, '\n'), 1) << said;
  }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ + "/" + name; }
};

/// The beginning of a TLS record with a handshake that never comes.
const std::string kHalfAHello("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11);

TEST_F(TlsTest, PageInterfaceAndUploads) {
  start_tls();
  EXPECT_THAT(server_->address(), testing::StartsWith("https://"));
  EXPECT_EQ(client().Get("/")->status, 200);
  teach_poster();
  const std::string exported = client().Get("/api/export")->body;
  EXPECT_GT(exported.size(), 16384U) << "more than one record";
  client().Delete("/api/objects/poster");
  post("/api/import", exported, "application/octet-stream");
  EXPECT_EQ(get("/api/objects")["objects"].size(), 1U);
}

TEST_F(TlsTest, WhoSendsTooMuchIsToldSo) {
  start_tls({"--set", "limits.body_mb=1"});
  const std::string body(5'000'000, 'x');
  EXPECT_TRUE(eventually([&] {  // on a busy machine the connection may end before all is sent
    const auto result = client().Post("/api/recognize", body, "image/png");
    return result && result->status == 413;
  }));
}

TEST_F(TlsTest, OnlyItsCertificateIsShown) {
  start_tls();
  make_certificate("other.pem", "other_key.pem");
  auto client = this->client();
  client.set_ca_cert_path(path("other.pem"));
  EXPECT_EQ(client.Get("/api/health").error(), httplib::Error::SSLServerVerification);
}

TEST_F(TlsTest, CookiesAreSecureAndPagesOfHttpAreStrangers) {
  const std::string token = "a token of some length";
  start_tls({}, {{"POSEVOTE_TOKEN", token}});
  const auto login = [&](const std::string& origin) {
    return client().Post("/api/login", {{"Origin", origin}}, Json{{"token", token}}.dump(),
                         "application/json");
  };
  const std::string host = "127.0.0.1:" + std::to_string(server_->port());
  EXPECT_EQ(login("http://" + host)->status, 403);
  const auto welcome = login("https://" + host);
  EXPECT_EQ(welcome->status, 204);
  EXPECT_THAT(welcome->get_header_value("Set-Cookie"), testing::HasSubstr("; Secure"));
}

TEST_F(TlsTest, FramesAndEventsStreamUntilTerminated) {
  start_tls({"--camera", make_camera("camera", {demo("test/breakfast.jpg")}), "--fps", "20"});
  client().Get("/api/stream.mjpg", [](const char*, std::size_t) { return false; });  // leaves
  std::atomic<int> watching = 0;
  std::vector<std::thread> watchers;
  for (const std::string what : {"/api/stream.mjpg", "/api/events"})
    watchers.emplace_back([&, what] {
      std::string text;
      bool enough = false;
      const auto result = this->client().Get(what, [&](const char* data, std::size_t size) {
        if (enough) return true;
        text.append(data, size);
        enough = text.find("X-Frame: 3\r\n") != std::string::npos ||
                 text.find("event: result") != std::string::npos;
        if (enough) ++watching;
        return true;
      });
      EXPECT_TRUE(result) << what << ": the stream ends in order";
    });
  EXPECT_TRUE(eventually([&] { return watching == 2; }));
  server_->send_signal(SIGTERM);
  EXPECT_EQ(server_->wait(), 0);
  for (std::thread& one : watchers) one.join();
}

TEST_F(TlsTest, WhoReadsNothingIsGivenUp) {
  start_tls({"--camera", make_camera("camera", {demo("test/breakfast.jpg")}), "--fps", "30",
             "--set", "limits.wait_s=1"});
  const auto nobody_watches = [&] {
    return eventually([&] {
      return client().Get("/metrics")->body.find("\nposevote_streams 0\n") != std::string::npos;
    });
  };
  bool given_up = false;
  client().Get("/api/stream.mjpg", [&](const char*, std::size_t) {
    given_up = given_up || nobody_watches();
    return true;
  });
  EXPECT_TRUE(given_up);
}

TEST_F(TlsTest, HandshakesThatNeverEndHoldNobodyUp) {
  start_tls({"--set", "limits.idle_s=600"});
  std::vector<int> stalled;
  stalled.reserve(12);
  for (int i = 0; i < 12; ++i) stalled.push_back(connection(i % 2 ? kHalfAHello : ""));
  EXPECT_EQ(get("/api/health")["status"], "ok");
  server_->send_signal(SIGTERM);
  EXPECT_EQ(server_->wait(), 0);
  for (const int socket : stalled) close(socket);
}

TEST_F(TlsTest, HandshakesThatNeverEndAreClosed) {
  start_tls({"--set", "limits.idle_s=1"});
  for (const std::string& bytes : {kHalfAHello, std::string()})
    EXPECT_EQ(rest_of(connection(bytes)), "");
}

TEST_F(TlsTest, ConnectionsTooManyAreClosed) {
  start_tls({"--set", "limits.connections=4", "--set", "limits.idle_s=600"});
  std::vector<int> stalled(4);
  for (int& socket : stalled) socket = connection("");
  EXPECT_TRUE(eventually([&] { return !client().Get("/api/health"); }));
  for (const int socket : stalled) close(socket);
  EXPECT_TRUE(eventually([&] { return bool(client().Get("/api/health")); }));
}

TEST_F(TlsTest, PlainHttpIsToldSoAndNonsenseIsClosed) {
  start_tls();
  const std::string request = "GET / HTTP/1.1\r\nHost: localhost\r\nX: ";
  const std::string answer = rest_of(connection(request + std::string(5000, 'x') + "\r\n\r\n"));
  EXPECT_THAT(answer, testing::StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(answer, testing::HasSubstr("https://"));
  EXPECT_THAT(answer, testing::Not(testing::EndsWith("reset")));
  rest_of(connection(std::string(1000, 'x')));
  EXPECT_EQ(get("/api/health")["status"], "ok");
}

TEST_F(TlsTest, FilesThatAreNoPairAreRefusedWithASentence) {
  const std::string cert = path("cert.pem"), key = path("key.pem"), text = path("text");
  std::ofstream(text) << "no PEM\n";
  make_certificate("other.pem", "other_key.pem");
  const auto refused = [&](const std::string& certificate_file, const std::string& key_file,
                           const std::string& words) {
    expect_refusal({"--tls-cert", certificate_file, "--tls-key", key_file}, 1, words);
  };
  refused(path("nothing"), key, path("nothing") + "' as a certificate");
  refused(cert, path("nothing"), path("nothing") + "': No such file");
  refused(text, key, text + "' as a certificate");
  refused(cert, text, text + "':");
  refused(cert, "", "''");
  refused(cert, path("other_key.pem"), "does not belong to");
  expect_refusal({"--tls-cert", cert}, 2, "--tls-key");
  expect_refusal({"--tls-key", key}, 2, "--tls-cert");
}

TEST_F(TlsTest, AKeyWithAPassphraseIsRefusedWithoutAQuestion) {
  const std::string command = "openssl pkey -aes128 -passout pass:secret -in " + path("key.pem") +
                              " -out " + path("locked.pem") + " 2> /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  expect_refusal({"--tls-cert", path("cert.pem"), "--tls-key", path("locked.pem")}, 1,
                 "without a passphrase");
}

}  // namespace
}  // namespace posevote
