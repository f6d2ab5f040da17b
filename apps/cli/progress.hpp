// A progress bar on standard error, drawn on terminals only.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace posevote::cli {

/// Draws "label [=====>    ] 12/40" and wipes itself at the end. Not thread-safe. Does nothing when
/// standard error is not a terminal.
class ProgressBar {
 public:
  ProgressBar(std::string label, std::size_t total);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void advance(std::size_t steps = 1);
  /// Wipes the bar, so that other output can be written; the next `advance` draws it again.
  void clear();

 private:
  void draw();

  std::string label_;
  std::size_t total_;
  std::size_t done_ = 0;
  bool enabled_;
  bool visible_ = false;
  std::chrono::steady_clock::time_point next_draw_{};
};

}  // namespace posevote::cli
