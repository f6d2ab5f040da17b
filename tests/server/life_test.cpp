// The server's end, expected and not; its camera's; its numbers.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>

#include "server_process.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;

class Life : public ServerTest {
 protected:
  std::string session_with_view() {
    std::string one =
        "/api/teach-sessions/" + post("/api/teach-sessions")["session"].get<std::string>();
    post(one + "/proposal", content(demo("train/poster/cover.jpg")));
    post(one + "/views");
    return one;
  }
};

TEST_F(Life, TerminatedItAnswersWhatIsInHand) {
  start();
  std::atomic<int> begun = 0, answered = 0;
  std::vector<std::thread> clients;
  clients.reserve(3);
  for (int i = 0; i < 3; ++i)
    clients.emplace_back([&] {
      auto client = this->client();
      const std::string scene = content(demo("test/kitchen.jpg"));
      for (;;) {
        ++begun;
        const auto result = client.Post("/api/recognize", scene, "image/jpeg");
        if (!result) return;  // a new request found the server gone
        EXPECT_EQ(result->status, 200);
        ++answered;
      }
    });
  ASSERT_TRUE(eventually([&] { return answered >= 3; }));
  server_->send_signal(SIGTERM);
  EXPECT_EQ(server_->wait(), 0);
  for (std::thread& one : clients) one.join();
}

TEST_F(Life, TerminatedWhilePeopleWatch) {
  start({"--camera", make_camera("camera", {demo("test/breakfast.jpg")})});
  std::thread watcher([&] {
    auto client = this->client();
    bool asked = false;  // a second signal does not wait for anyone
    client.Get("/api/stream.mjpg", [&](const char*, std::size_t) {
      if (!asked) server_->send_signal(SIGTERM);
      asked = true;
      return true;
    });
  });
  watcher.join();  // the stream ends by itself
  EXPECT_EQ(server_->wait(), 0);
}

TEST_F(Life, KilledItLosesTheViewInHandAtMost) {
  start();
  const std::string one = session_with_view();
  post(one + "/proposal", content(demo("train/muesli/y000.jpg")));
  server_->send_signal(SIGKILL);
  EXPECT_EQ(server_->wait(), -SIGKILL);
  start();
  const Json session = get(one);
  EXPECT_EQ(session["views"].size(), 1U);
  EXPECT_EQ(session["proposal"], false);
  post(one + "/save", R"({"object": "poster"})", "application/json");
  EXPECT_EQ(get("/api/objects/poster")["views"].size(), 1U);
}

TEST_F(Life, KilledAtAnyMomentOfTeachingNothingAcceptedIsLost) {
  start();
  const std::string one = session_with_view();
  std::atomic<std::size_t> accepted = 1;
  for (int round = 0; round < 3; ++round) {
    const std::size_t before = accepted;
    std::thread teacher([&] {
      auto client = this->client();
      for (int deg = 0; deg < 324; deg += 36) {
        char name[40];
        std::snprintf(name, sizeof name, "train/book/y%03d.jpg", deg);
        const std::string whole = "/proposal?whole=true&yaw=" + std::to_string(round * 7 + deg);
        if (!client.Post(one + whole, content(demo(name)), "image/jpeg")) return;
        const auto result = client.Post(one + "/views");
        if (!result) return;
        if (result->status == 201) ++accepted;
      }
    });
    EXPECT_TRUE(eventually([&] { return accepted > before; }));
    server_->send_signal(SIGKILL);
    server_->wait();
    teacher.join();
    start();
    const std::size_t kept = get(one)["views"].size();
    EXPECT_GE(kept, accepted);
    EXPECT_LE(kept, accepted + 1) << "the one in hand may have been finished";
    accepted = kept;
  }
}

TEST_F(Life, ALostSourceIsToldAndComesBackByItself) {
  const std::string camera = make_camera("camera", {demo("test/breakfast.jpg")});
  start({"--camera", camera, "--fps", "20"});
  const auto state_is = [&](const std::string& state) {
    return eventually([&] { return get("/api/live")["state"] == state; });
  };
  EXPECT_TRUE(state_is("running"));
  fs::rename(camera, camera + "-away");
  EXPECT_TRUE(state_is("lost"));
  const Json lost = get("/api/live");
  EXPECT_NE(lost["message"].get<std::string>().find("camera"), std::string::npos);
  EXPECT_FALSE(lost.contains("result"));
  fs::rename(camera + "-away", camera);
  EXPECT_TRUE(state_is("running"));
  EXPECT_EQ(get("/api/live")["message"], "");
}

TEST_F(Life, ASourceThatIsNotThereYetIsWaitedFor) {
  const std::string camera = folder_ + "/later";
  start({"--camera", camera, "--camera", "client"});
  EXPECT_TRUE(eventually([&] { return get("/api/live")["state"] == "lost"; }));
  make_camera("later", {demo("test/breakfast.jpg")});
  EXPECT_TRUE(eventually([&] { return get("/api/live")["state"] == "running"; }));
}

TEST_F(Life, AStreamOverHttpIsASource) {
  start({"--camera", make_camera("camera", {demo("test/breakfast.jpg")}), "--fps", "20"});
  const std::string address =
      "http://127.0.0.1:" + std::to_string(server_->port()) + "/api/stream.mjpg";
  fs::create_directory(folder_ + "/second");
  const ServerProcess second(folder_ + "/second", {"--camera", address});
  const auto state_is = [&](const std::string& state) {
    return eventually(
        [&] { return Json::parse(second.client().Get("/api/live")->body)["state"] == state; });
  };
  EXPECT_TRUE(state_is("running"));
  const int port = server_->port();
  server_->send_signal(SIGKILL);
  server_->wait();
  EXPECT_TRUE(state_is("lost"));
  start({"--camera", folder_ + "/camera", "--fps", "20", "--listen",
         "127.0.0.1:" + std::to_string(port)});
  EXPECT_TRUE(state_is("running")) << "it comes back by itself";
}

/// A camera in the network; killed when it goes.
class RtspCamera {
 public:
  /// `port`: "0" is any free one.
  RtspCamera(const std::string& picture, const std::string& port) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    const std::string script = std::string(POSEVOTE_SOURCE_DIR) + "/tests/server/rtsp_server.py";
    pid_ = fork();
    if (pid_ == 0) {
      dup2(ends[1], STDOUT_FILENO);
      execl("/usr/bin/python3", "python3", script.c_str(), picture.c_str(), port.c_str(), nullptr);
      _exit(127);
    }
    close(ends[1]);
    for (char c; read(ends[0], &c, 1) == 1 && c != '\n';) address_ += c;
    close(ends[0]);
  }
  ~RtspCamera() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  RtspCamera(const RtspCamera&) = delete;
  RtspCamera& operator=(const RtspCamera&) = delete;

  [[nodiscard]] const std::string& address() const { return address_; }  ///< "": it did not begin
  [[nodiscard]] std::string port() const {
    const std::size_t from = address_.rfind(':') + 1;
    return address_.substr(from, address_.rfind('/') - from);
  }

 private:
  int pid_ = -1;
  std::string address_;
};

TEST_F(Life, ACameraInTheNetworkIsASource) {
  if (std::system(
          "/usr/bin/python3 -c \"import gi; gi.require_version('GstRtspServer', '1.0')\"") != 0)
    GTEST_SKIP() << "gir1.2-gst-rtsp-server-1.0 and python3-gi are not installed";
  const std::string picture = demo("test/breakfast.jpg");
  auto camera = std::make_unique<RtspCamera>(picture, "0");
  const std::string address = camera->address(), port = camera->port();
  ASSERT_NE(address, "");
  start({"--camera", address});
  const auto state_is = [&](const std::string& state) {
    return eventually([&] { return get("/api/live")["state"] == state; });
  };
  EXPECT_TRUE(state_is("running"));
  camera.reset();
  EXPECT_TRUE(state_is("lost"));
  EXPECT_NE(get("/api/live")["message"].get<std::string>().find(address), std::string::npos);
  camera = std::make_unique<RtspCamera>(picture, port);
  EXPECT_TRUE(state_is("running")) << "it comes back by itself";
  start({"--camera", address, "--set", "limits.megapixels=0.1"});
  EXPECT_TRUE(state_is("lost"));
  EXPECT_NE(get("/api/live")["message"].get<std::string>().find("too large"), std::string::npos);
}

TEST_F(Life, MetricsCountWhatHappened) {
  start({"--camera", make_camera("camera", {demo("test/breakfast.jpg")})});
  teach_poster();
  post("/api/recognize", content(demo("train/poster/cover.jpg")));
  EXPECT_EQ(client().Get("/api/objects/nobody")->status, 404);
  const std::string all = client().Get("/metrics")->body;
  for (const std::string line :
       {"posevote_recognitions_total{of=\"upload\"} 1", "posevote_objects 1", "posevote_views 1",
        "posevote_views_taught_total 1", "posevote_http_requests_total{status=\"404\"} 1",
        "# TYPE posevote_stage_seconds histogram", "posevote_detections_total 1"})
    EXPECT_NE(all.find(line), std::string::npos) << line << "\n" << all;
  for (const std::string name :
       {"posevote_stage_seconds_bucket{stage=\"detect\",le=\"+Inf\"}", "posevote_frames_total",
        "posevote_frames_skipped_total", "posevote_frames_dropped_total", "posevote_database_bytes",
        "posevote_features_total", "posevote_result_age_seconds_count",
        "process_resident_memory_bytes"})
    EXPECT_NE(all.find(name), std::string::npos) << name;
}

TEST_F(Life, WhatOthersTeachIsTakenOver) {
  start();
  const std::string command = std::string(POSEVOTE_PROGRAM) + " teach poster --whole " +
                              demo("train/poster/cover.jpg") + " --db " + folder_ +
                              "/objects.db > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_TRUE(eventually([&] { return get("/api/live")["objects"] == 1; }));
}

}  // namespace
}  // namespace posevote
