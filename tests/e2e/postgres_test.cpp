// The commands with a database on a PostgreSQL server.
#include "posevote/store/postgres/postgres_store.hpp"

#include <arpa/inet.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <thread>

#include "posevote/json/recognition_json.hpp"
#include "posevote/store/postgres/test_server.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"
#include "posevote/store/sync.hpp"
#include "program.hpp"
#ifdef POSEVOTE_WITH_SERVER
#include "../server/server_process.hpp"
#include "posevote/store/postgres/relay.hpp"
#endif

namespace posevote {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class SharedDatabase : public Program {
 protected:
  void SetUp() override {
    if (!server_.runs()) GTEST_SKIP() << "no test server; run ctest";
    server_.make(name_);
  }

  const postgres::TestServer server_;
  const std::string name_ = folder_.substr(folder_.rfind('/') + 1);
  const std::string address_ = server_.address(name_);
};

/// A line of `recognize --json` without its times.
Json without_times(const std::string& line) {
  Json json = Json::parse(line);
  json.erase("time_ms");
  return json;
}

TEST_F(SharedDatabase, TaughtAndRecognisedAsInAFile) {
  for (const std::string& database : {database(), address_}) {
    const Outcome taught =
        run({"teach", "poster", demo("train/poster/cover.jpg"), "--db", database});
    EXPECT_EQ(taught.status, 0) << taught.err;
  }
  const std::string scene = demo("test/reading.jpg");
  const Outcome by_file = run({"recognize", scene, "--json"});
  const Outcome by_server = run({"recognize", scene, "--json", "--db", address_});
  ASSERT_EQ(by_server.status, 0) << by_server.err;
  EXPECT_EQ(without_times(by_server.lines().at(0)), without_times(by_file.lines().at(0)));
  const Outcome difference = run({"objects", "diff", database(), address_, "--json"});
  EXPECT_EQ(Json::parse(difference.lines().at(0))["in_both"], 1);
  EXPECT_EQ(run({"objects", "rename", "poster", "big poster", "--db", address_}).status, 0);
  EXPECT_THAT(run({"objects", "list", "--names", "--db", address_}).out, "big poster\n");
  EXPECT_EQ(run({"objects", "export", path("all.posevote"), "--db", address_}).status, 0);
  EXPECT_EQ(open_sqlite_store(path("all.posevote"))->list().size(), 1U);
}

TEST_F(SharedDatabase, ARobotThatWasAwayComesBack) {
  ASSERT_EQ(run({"teach", "poster", demo("train/poster/cover.jpg"), "--db", address_}).status, 0);
  ASSERT_EQ(run({"sync", address_}).status, 0);
  // Away: it teaches into its own database, others into the shared one; one of them tidies up.
  ASSERT_EQ(run({"teach", "soup", demo("train/soup/y000.jpg"), "--whole"}).status, 0);
  ASSERT_EQ(run({"teach", "mug", demo("train/mug/y000.jpg"), "--whole", "--db", address_}).status,
            0);
  ASSERT_EQ(run({"objects", "remove", "poster", "--db", address_}).status, 0);
  const Outcome back = run({"sync", address_, "--json"});
  ASSERT_EQ(back.status, 0) << back.err;
  const Json report = Json::parse(back.lines().at(0));
  EXPECT_EQ(report["sent"].size(), 1U);
  EXPECT_EQ(report["received"].size(), 1U);
  EXPECT_EQ(report["removed_here"].size(), 1U);
  for (const std::string& database : {database(), address_})
    EXPECT_EQ(run({"objects", "list", "--names", "--db", database}).out, "mug\nsoup\n");
}

TEST_F(SharedDatabase, ASyncThatLosesItsConnectionIsSimplyRunAgain) {
  const auto here = open_sqlite_store(database());
  const auto there = open_postgres_store(address_);
  const FeatureRecord features = record_features({});
  for (int i = 0; i < 30; ++i)
    (i % 3 ? *here : *there).add_view("mug", made_view(i, 400), features);
  std::size_t views = 0;
  for (int attempt = 0; attempt < 5; ++attempt) {
    const pid_t child = start({"sync", address_});
    while (there->list().empty() || list_views(*there).size() <= views)
      if (waitpid(child, nullptr, WNOHANG) != 0) break;
    server_.break_connections(name_);
    waitpid(child, nullptr, 0);
    EXPECT_GE(list_views(*there).size(), views);
    views = list_views(*there).size();
  }
  EXPECT_EQ(run({"sync", address_}).status, 0);
  EXPECT_EQ(compare_views(list_views(*here), list_views(*there)).in_both, 30U);
}

TEST_F(SharedDatabase, ARunningRecogniserLearnsWithoutMissingAFrame) {
  cv::Mat frame;
  cv::resize(cv::imread(demo("train/poster/cover.jpg")), frame, {320, 240}, 0, 0, cv::INTER_AREA);
  {
    cv::VideoWriter writer(path("clip.avi"), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10,
                           frame.size());
    for (int i = 0; i < 5000; ++i) writer.write(frame);
  }
  for (const std::string& database : {database(), address_}) {
    ASSERT_EQ(
        run({"teach", "soup", demo("train/soup/y000.jpg"), "--whole", "--db", database}).status, 0);
    const std::string out = path(database == address_ ? "server.jsonl" : "file.jsonl");
    const pid_t child = start({"recognize", path("clip.avi"), "--json", "--db", database}, out);
    const auto shows = [&](const std::string& word) {
      return content(out).find(word) != std::string::npos;
    };
    const auto wait_for = [&](const std::string& word) {
      while (!shows(word) && waitpid(child, nullptr, WNOHANG) == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      return shows(word);
    };
    EXPECT_TRUE(wait_for("\"frame\":3"));
    EXPECT_FALSE(shows("poster"));
    ASSERT_EQ(run({"teach", "poster", demo("train/poster/cover.jpg"), "--db", database}).status, 0);
    EXPECT_TRUE(wait_for("poster"));
    ASSERT_EQ(run({"objects", "rename", "poster", "picture", "--db", database}).status, 0);
    EXPECT_TRUE(wait_for("picture"));
    kill(child, SIGINT);
    waitpid(child, nullptr, 0);
    std::ifstream lines(out);
    int number = 0;
    for (std::string line; std::getline(lines, line); ++number)
      ASSERT_EQ(Json::parse(line)["frame"], number);
    EXPECT_LT(number, 5000) << "the clip is too short for this machine";
  }
}

#ifdef POSEVOTE_WITH_SERVER
TEST_F(SharedDatabase, AServerGoesOnWhileItCannotBeReached) {
  ASSERT_EQ(run({"teach", "poster", demo("train/poster/cover.jpg"), "--db", address_}).status, 0);
  postgres::Relay relay(server_.socket_path());
  const ServerProcess server(folder_, {"--db", relay.address(name_), "--state", path("state")});
  const std::string scene = content(demo("test/reading.jpg"));
  const auto found = [&] {
    const auto answer = server.client().Post("/api/recognize", scene, "image/jpeg");
    return answer && answer->status == 200
               ? Json::parse(answer->body)["detections"].at(0)["object"].get<std::string>()
               : "";
  };
  EXPECT_EQ(found(), "poster");
  relay.set_down(true);
  open_postgres_store(address_)->rename_object("poster", "picture");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(found(), "poster");
  EXPECT_TRUE(eventually([&] {  // it is told once
    return content(path("err.txt")).find("cannot be reached") != std::string::npos;
  }));
  EXPECT_EQ(found(), "poster");
  relay.set_down(false);
  EXPECT_TRUE(eventually([&] { return found() == "picture"; }));
}
#endif

#ifdef POSEVOTE_PYTHON_PROGRAM
TEST_F(SharedDatabase, ABatchReadsItsObjectsFromIt) {
  if (std::system("'" POSEVOTE_PYTHON_PROGRAM "' -c 'import distributed' 2>/dev/null") != 0)
    GTEST_SKIP() << "there is no Dask";
  server_.run("postgres", "CREATE ROLE \"" + name_ + "\" LOGIN SUPERUSER PASSWORD 'it''s secret?'");
  const std::string address = server_.loopback(name_, name_ + ":it's secret?");
  const std::string scene = demo("test/reading.jpg"), out = path("out.jsonl");
  ASSERT_EQ(run({"teach", "poster", demo("train/poster/cover.jpg"), "--db", address}).status, 0);
  const Outcome outcome = run({"batch", scene, "--db", address, "--out", out, "--workers", "1"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const Outcome expected = run({"recognize", scene, "--db", address, "--json"});
  EXPECT_EQ(without_times(content(out)), without_times(expected.lines().at(0)));
}
#endif

TEST_F(SharedDatabase, NoPasswordIsInTheListOfProcesses) {
  // A server that takes the call and never answers: the program waits for it.
  const int listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
  ASSERT_EQ(listen(listener, 1), 0);
  socklen_t size = sizeof place;
  getsockname(listener, reinterpret_cast<sockaddr*>(&place), &size);
  const std::string database = "@127.0.0.1:" + std::to_string(ntohs(place.sin_port)) + "/db";
  for (const char* password : {"secret", "a?secret", "it's secret", "\"secret\"", "%25secret"})
    for (const std::string& address : {std::string("robot:") + password + database,
                                       "robot" + database + "?sslpassword=" + password}) {
      const pid_t child = start({"objects", "list", "--db", "postgresql://" + address});
      const int call = accept(listener, nullptr, nullptr);
      const std::string words = content("/proc/" + std::to_string(child) + "/cmdline");
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
      close(call);
      EXPECT_THAT(words, AllOf(HasSubstr("***"), Not(HasSubstr("secret"))));
    }
  close(listener);
}

TEST_F(SharedDatabase, NoPasswordIsSaid) {
  for (const std::string address :
       {"robot:a?secret@127.0.0.1:1/db", "robot:100%secret@127.0.0.1/db",
        "robot:it's secret@127.0.0.1:1/db", "127.0.0.1:1/db?password=a secret"})
    for (const Outcome& outcome :
         {run({"objects", "list", "--db", "postgresql://" + address}),
          run({"objects", "list", "postgresql://" + address}), run({"postgresql://" + address})}) {
      EXPECT_NE(outcome.status, 0);
      EXPECT_THAT(outcome.out + outcome.err, AllOf(HasSubstr("***"), Not(HasSubstr("secret"))));
    }
}

}  // namespace
}  // namespace posevote
