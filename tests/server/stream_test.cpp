// Frames and events for many clients at once, fast and slow.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <set>

#include "server_process.hpp"

namespace posevote {
namespace {

class Streams : public ServerTest {
 protected:
  void SetUp() override {
    camera_ = make_camera("camera", {demo("test/breakfast.jpg"), demo("test/kitchen.jpg")});
  }

  /// Watches until `enough` says so of all that has come; false when the stream ends before. Asks
  /// only when an empty line, which ends a head or an event, has come: looking through all of it
  /// for every piece takes longer than frames take to come.
  bool watch(const std::string& path, const std::function<bool(const std::string&)>& enough) {
    auto client = this->client();
    std::string text;
    bool reached = false;
    client.Get(path, [&](const char* data, std::size_t size) {
      const std::size_t from = text.size() < 3 ? 0 : text.size() - 3;
      text.append(data, size);
      if (text.find("\r\n\r\n", from) != std::string::npos ||
          text.find("\n\n", from) != std::string::npos)
        reached = enough(text);
      return !reached;
    });
    return reached;
  }

  static std::set<std::int64_t> frames_in(const std::string& text) {
    std::set<std::int64_t> numbers;
    const std::string name = "X-Frame: ";
    constexpr std::size_t kDigits = 18;  // all that follows would be copied for each frame
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1))
      numbers.insert(std::stoll(text.substr(at + name.size(), kDigits)));
    return numbers;
  }

  static std::vector<Json> results_in(const std::string& text) {
    std::vector<Json> results;
    const std::string begin = "event: result\ndata: ";
    for (std::size_t at = text.find(begin); at != std::string::npos;
         at = text.find(begin, at + 1)) {
      const std::size_t from = at + begin.size(), to = text.find("\n\n", from);
      if (to != std::string::npos) results.push_back(Json::parse(text.substr(from, to - from)));
    }
    return results;
  }

  double metric(const std::string& name) {
    const std::string all = client().Get("/metrics")->body;
    const std::size_t at = all.find("\n" + name + " ");
    return at == std::string::npos ? -1 : std::stod(all.substr(at + name.size() + 2));
  }

  /// A connection whose owner asks for the stream and then reads nothing.
  int sleeping_client() {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    const int small = 4096;
    setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(server_->port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    const std::string request = "GET /api/stream.mjpg HTTP/1.1\r\nHost: localhost\r\n\r\n";
    EXPECT_EQ(send(socket, request.data(), request.size(), 0),
              static_cast<ssize_t>(request.size()));
    return socket;
  }

  std::string camera_;
};

TEST_F(Streams, FramesAreJpegWithTheirNumbers) {
  start({"--camera", camera_, "--fps", "20"});
  std::string text;
  EXPECT_TRUE(watch("/api/stream.mjpg", [&](const std::string& so_far) {
    text = so_far;
    return frames_in(so_far).size() >= 3;
  }));
  EXPECT_NE(text.find("--frame\r\nContent-Type: image/jpeg"), std::string::npos);
  EXPECT_NE(text.find("\xff\xd8\xff"), std::string::npos);
}

TEST_F(Streams, DrawnFramesToo) {
  start({"--camera", camera_, "--fps", "20"});
  EXPECT_TRUE(watch("/api/stream.mjpg?annotated=true",
                    [](const std::string& text) { return frames_in(text).size() >= 2; }));
}

TEST_F(Streams, EventsTellResultsStateAndChangesOfTheObjects) {
  start({"--camera", camera_, "--fps", "20"});
  bool taught = false;
  EXPECT_TRUE(watch("/api/events", [&](const std::string& text) {
    if (!taught && !results_in(text).empty()) {
      teach_poster();
      taught = true;
    }
    std::size_t changes = 0;
    for (std::size_t at = 0; (at = text.find("event: objects", at)) != std::string::npos; ++at)
      ++changes;
    return text.find("event: live") != std::string::npos && changes >= 2;
  }));
}

TEST_F(Streams, EachFrameIsRecognisedOnceForAllClients) {
  start({"--camera", camera_, "--fps", "10"});
  std::vector<std::thread> clients;
  clients.reserve(6);
  std::atomic<int> satisfied = 0;
  for (int i = 0; i < 6; ++i)
    clients.emplace_back([&] {
      if (watch("/api/events",
                [](const std::string& text) { return results_in(text).size() >= 5; }))
        ++satisfied;
    });
  for (std::thread& one : clients) one.join();
  EXPECT_EQ(satisfied, 6);
  EXPECT_LE(metric("posevote_recognitions_total{of=\"live\"}"), metric("posevote_frames_total"));
  EXPECT_TRUE(eventually([&] { return metric("posevote_streams") == 0; })) << "they have all left";
}

TEST_F(Streams, ASleepingClientHoldsNobodyUpAndIsLeftBehind) {
  start({"--camera", camera_, "--fps", "30", "--set", "limits.wait_s=3"});
  const int asleep = sleeping_client();
  ASSERT_TRUE(eventually([&] { return metric("posevote_streams") == 1; }));
  const double before = metric("posevote_frames_total");
  EXPECT_TRUE(eventually([&] {  // on a busy machine we may seem to be asleep ourselves
    return watch("/api/stream.mjpg",
                 [](const std::string& text) { return frames_in(text).size() >= 40; });
  }));
  EXPECT_GE(metric("posevote_frames_total"), before + 39);  // the first was there before
  EXPECT_TRUE(eventually([&] { return metric("posevote_streams") == 0; }))
      << "who reads nothing is given up";
  close(asleep);
}

TEST_F(Streams, ManyConnectionsAreTurnedAwayWithASentence) {
  start({"--camera", camera_, "--set", "limits.connections=4", "--set", "limits.wait_s=600"});
  std::vector<int> held(4);
  for (int& socket : held) socket = sleeping_client();
  httplib::Result result(nullptr, httplib::Error::Unknown);
  EXPECT_TRUE(eventually([&] {
    result = client().Get("/api/health");
    return result && result->status == 503;
  }));
  EXPECT_EQ(Json::parse(result->body)["error"]["code"], "busy");
  for (const int socket : held) close(socket);
  EXPECT_TRUE(eventually([&] {
    result = client().Get("/api/health");
    return result && result->status == 200;
  }));
}

}  // namespace
}  // namespace posevote
