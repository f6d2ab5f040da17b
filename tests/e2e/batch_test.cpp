// posevote batch: the program, the Python package behind it, and Dask.
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "posevote/core/arguments.hpp"
#include "posevote/json/recognition_json.hpp"
#include "program.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class BatchCommand : public Program {
 protected:
  void SetUp() override {
    if (std::system("'" POSEVOTE_PYTHON_PROGRAM "' -c 'import distributed' 2>/dev/null") != 0)
      GTEST_SKIP() << "there is no Dask";
    teach_poster();
    fs::create_directory(path("pictures"));
    for (const auto* name : {"reading", "kitchen", "breakfast"}) {
      cv::Mat small;
      cv::resize(cv::imread(demo("test/" + std::string(name) + ".jpg")), small, {640, 480});
      cv::imwrite(path("pictures/" + std::string(name) + ".jpg"), small);
    }
  }

  /// Lines of JSON without their times.
  static std::vector<Json> lines_of(const std::string& text) {
    std::vector<Json> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
      lines.push_back(Json::parse(line));
      for (const char* key : {"time_ms", "latency_ms", "per_second"}) lines.back().erase(key);
    }
    return lines;
  }

  /// What `recognize` says of the inputs; `batch` must say the same.
  std::vector<Json> recognized(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"recognize", "--json"});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return lines_of(outcome.out);
  }
  std::vector<Json> batched(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"batch", "--out", out_, "--restart", "--workers", "2"});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out + outcome.err, "");
    return lines_of(content(out_));
  }

  /// Runs posevote on a terminal of its own; returns what it showed there.
  std::string run_on_terminal(const std::vector<std::string>& arguments, int& status) const {
    int terminal = -1;
    const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
    if (child == 0) {
      setenv("POSEVOTE_DB", database().c_str(), 1);
      std::vector<std::string> words{POSEVOTE_PROGRAM};
      words.insert(words.end(), arguments.begin(), arguments.end());
      execv(POSEVOTE_PROGRAM, argv_of(words).data());
      _exit(127);
    }
    std::string shown;
    char buffer[4096];
    for (ssize_t count = 0; (count = read(terminal, buffer, sizeof buffer)) > 0;)
      shown.append(buffer, static_cast<std::size_t>(count));
    close(terminal);
    waitpid(child, &status, 0);
    return shown;
  }

  const std::string out_ = path("out.jsonl");
};

TEST_F(BatchCommand, AFolderIsRecognisedAsByRecognize) {
  const auto expected = recognized({path("pictures")});
  EXPECT_EQ(expected.size(), 3U);
  EXPECT_EQ(batched({path("pictures")}), expected);
  const std::vector<std::string> set{path("pictures"), "--set", "feature.max_features=60"};
  EXPECT_EQ(batched(set), recognized(set));
  EXPECT_NE(batched(set), expected);
}

TEST_F(BatchCommand, AListIsReadFromStandardInput) {
  const std::string first = path("pictures/reading.jpg"), second = path("pictures/kitchen.jpg");
  const std::string command = "printf '%s\\n' '" + first + "' '" + second + "' | POSEVOTE_DB='" +
                              database() + "' '" POSEVOTE_PROGRAM "' batch --list - --out '" +
                              out_ + "' --workers 1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(lines_of(content(out_)), recognized({first, second}));
}

TEST_F(BatchCommand, OfAVideoEveryNthFrame) {
  {
    cv::VideoWriter writer(path("clip.avi"), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10,
                           {640, 480});
    for (const auto* name : {"reading", "kitchen", "breakfast", "reading", "kitchen"})
      writer.write(cv::imread(path("pictures/" + std::string(name) + ".jpg")));
  }
  const std::vector<std::string> arguments{path("clip.avi"), "--every", "2"};
  const auto lines = batched(arguments);
  EXPECT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines, recognized(arguments));
}

TEST_F(BatchCommand, OnATerminalItShowsHowFarItIs) {
  int status = -1;
  const std::string shown =
      run_on_terminal({"batch", path("pictures"), "--out", out_, "--workers", "1"}, status);
  EXPECT_EQ(status, 0) << shown;
  EXPECT_THAT(shown, HasSubstr("dashboard: http://127.0.0.1:"));
  EXPECT_THAT(shown, HasSubstr("recognising ["));
  EXPECT_THAT(shown, HasSubstr("] 3/3"));
  EXPECT_EQ(lines_of(content(out_)), recognized({path("pictures")}));
}

TEST_F(BatchCommand, WhatIsWrongIsSaidInOneSentence) {
  expect_failure(run({"batch", path("pictures"), "--out", out_, "--set", "match.no_such=1"}), 1,
                 {"no_such"});
  expect_failure(run({"batch", path("nothing"), "--out", out_, "--workers", "1"}), 1,
                 {out_, "1 lines"});
  EXPECT_THAT(content(out_), HasSubstr("nothing"));
  expect_failure(run({"batch", "--out", out_}), 2, {"--list"});
}

}  // namespace
}  // namespace posevote
