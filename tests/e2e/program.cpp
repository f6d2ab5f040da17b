#include "program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "posevote/core/arguments.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;

int open_program() {
  return open(POSEVOTE_PROGRAM, O_PATH | O_CLOEXEC);
}

/// `program` is open already: another user may not be let into its folder.
[[noreturn]] void become_posevote(int program, const std::vector<std::string>& arguments,
                                  const std::string& database, const std::string& out,
                                  const std::string& err) {
  constexpr int mode = 0600;
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, mode), STDOUT_FILENO);
  dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, mode), STDERR_FILENO);
  setenv("POSEVOTE_DB", database.c_str(), 1);
  std::vector<std::string> words{POSEVOTE_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  fexecve(program, argv_of(words).data(), environ);
  _exit(127);
}

}  // namespace

std::vector<std::string> Outcome::lines() const {
  std::vector<std::string> lines;
  std::istringstream stream(out);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

Program::Program() {
  std::string pattern = (fs::temp_directory_path() / "posevote_e2e.XXXXXX").string();
  folder_ = mkdtemp(pattern.data());
  fs::permissions(folder_, fs::perms::all);  // some tests run posevote as another user
}

Program::~Program() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

Outcome Program::run(const std::vector<std::string>& arguments,
                     const std::function<void()>& before) const {
  // Outputs lie outside the folder: its disk may be full, its permissions gone.
  std::string pattern = (fs::temp_directory_path() / "posevote_e2e_out.XXXXXX").string();
  const fs::path output = mkdtemp(pattern.data());
  const pid_t child = fork();
  if (child == 0) {
    const int program = open_program();
    if (before) {
      fs::permissions(output, fs::perms::all);
      before();
    }
    become_posevote(program, arguments, database(), output / "out", output / "err");
  }
  int status = 0;
  waitpid(child, &status, 0);
  Outcome outcome;
  if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  outcome.out = content(output / "out");
  outcome.err = content(output / "err");
  fs::remove_all(output);
  return outcome;
}

pid_t Program::start(const std::vector<std::string>& arguments, const std::string& out) const {
  const pid_t child = fork();
  if (child == 0) become_posevote(open_program(), arguments, database(), out, "/dev/null");
  return child;
}

void Program::teach_poster() const {
  const Outcome taught = run({"teach", "poster", demo("train/poster/cover.jpg")});
  ASSERT_EQ(taught.status, 0) << taught.err;
}

std::string Program::small_scene() const {
  cv::Mat scene;
  cv::resize(cv::imread(demo("test/kitchen.jpg")), scene, {320, 240}, 0, 0, cv::INTER_AREA);
  return write("scene.jpg", scene);
}

void Program::expect_failure(const Outcome& outcome, int status,
                             const std::vector<std::string>& words) {
  EXPECT_EQ(outcome.signal, 0);
  EXPECT_EQ(outcome.status, status) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.err, testing::StartsWith("posevote: "));
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << "one sentence: " << outcome.err;
  for (const std::string& word : words) EXPECT_THAT(outcome.err, testing::HasSubstr(word));
}

std::string Program::demo(const std::string& name) {
  return POSEVOTE_SOURCE_DIR "/data/demo/" + name;
}

std::string Program::write(const std::string& name, const std::string& data) const {
  std::ofstream(path(name), std::ios::binary) << data;
  return path(name);
}

std::string Program::write(const std::string& name, const cv::Mat& image) const {
  cv::imwrite(path(name), image);
  return path(name);
}

std::string Program::content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace posevote
