#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <latch>
#include <thread>

#include "api/routes.hpp"
#include "http/problem.hpp"
#include "json.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"

namespace posevote::server {
namespace {

namespace fs = std::filesystem;

class SessionRoutes : public testing::Test {
 protected:
  SessionRoutes() {
    fs::create_directory(folder_);
    StudioConfig config;
    config.store = open_sqlite_store(folder_ + "/objects.db");
    config.folder = folder_ + "/studio";
    config.options.limits.jobs = 1;
    config.options.limits.wait_s = 5;
    config.report = [](const std::string&) {};
    studio_ = std::make_unique<Studio>(std::move(config));
    add_session_routes(router_, *studio_);
  }
  ~SessionRoutes() override {
    studio_.reset();
    fs::remove_all(folder_);
  }

  /// A look at a picture with nothing in it; returns the status.
  int look(
      const std::string& session, const std::function<void()>& body_read = [] {}) {
    Request request;
    request.method = "POST";
    request.path = "/api/teach-sessions/" + session + "/proposal";
    request.read_body = [&](std::size_t) {
      Body body;
      body.raw = encode_png(cv::Mat::zeros(60, 80, CV_8UC3));
      body_read();
      return body;
    };
    try {
      return router_.find(request).handler(request).status;
    } catch (const Problem& problem) {
      return problem.status();
    }
  }

  std::string folder_ =
      (fs::temp_directory_path() / ("posevote-looks-" + std::to_string(getpid()))).string();
  std::unique_ptr<Studio> studio_;
  Router router_;
};

TEST_F(SessionRoutes, WhoWaitsForALookHoldsNoPlaceAmongTheJobs) {
  const auto session = studio_->sessions.create(), other = studio_->sessions.create();
  auto in_hand = std::make_unique<JobSlots::Slot>(session->looks());
  std::latch read(1);
  std::jthread second([&] { look(session->id(), [&] { read.count_down(); }); });
  read.wait();
  EXPECT_EQ(look(other->id()), 200);
  in_hand.reset();
  second.join();
  EXPECT_EQ(look(session->id()), 200);
}

}  // namespace
}  // namespace posevote::server
