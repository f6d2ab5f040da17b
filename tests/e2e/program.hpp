// Runs the real executable and makes what it is fed with.
#pragma once

#include <gmock/gmock.h>
#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace posevote {

struct Outcome {
  int status = -1;  ///< exit status; -1: died of a signal
  int signal = 0;
  std::string out, err;

  [[nodiscard]] std::vector<std::string> lines() const;  ///< of standard output
};

/// A folder with a database and pictures, in which posevote is run.
class Program : public testing::Test {
 protected:
  Program();
  ~Program() override;

  /// Runs posevote with the folder's database (by $POSEVOTE_DB) and waits for it. `before` runs in
  /// the child process first, e.g. to set limits.
  Outcome run(const std::vector<std::string>& arguments,
              const std::function<void()>& before = {}) const;
  /// The same without waiting; its output goes to the file `out`.
  [[nodiscard]] pid_t start(const std::vector<std::string>& arguments,
                            const std::string& out = "/dev/null") const;

  /// Teaches the demo poster; the database must then look the same after whatever goes wrong.
  void teach_poster() const;
  /// A small picture in which objects of the demonstration stand.
  [[nodiscard]] std::string small_scene() const;

  /// Expects that `outcome` is a failure of this status with one sentence that holds `words`.
  static void expect_failure(const Outcome& outcome, int status,
                             const std::vector<std::string>& words);

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ + "/" + name; }
  [[nodiscard]] std::string database() const { return path("objects.db"); }
  [[nodiscard]] static std::string demo(const std::string& name);
  std::string write(const std::string& name, const std::string& data) const;
  std::string write(const std::string& name, const cv::Mat& image) const;
  [[nodiscard]] static std::string content(const std::string& path);

  std::string folder_;
};

}  // namespace posevote
