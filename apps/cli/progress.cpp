#include "progress.hpp"

#include <unistd.h>

#include <iostream>

namespace posevote::cli {
namespace {

constexpr std::size_t bar_width = 30;
constexpr std::chrono::milliseconds draw_interval{50};

}  // namespace

ProgressBar::ProgressBar(std::string label, std::size_t total)
    : label_(std::move(label)), total_(total), enabled_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::advance(std::size_t steps) {
  done_ += steps;
  const auto now = std::chrono::steady_clock::now();
  if (!enabled_ || now < next_draw_) return;
  next_draw_ = now + draw_interval;
  draw();
}

void ProgressBar::clear() {
  if (!visible_) return;
  std::cerr << "\r\033[K" << std::flush;
  visible_ = false;
}

void ProgressBar::draw() {
  const std::size_t filled = total_ == 0 ? 0 : std::min(bar_width, bar_width * done_ / total_);
  std::cerr << "\r\033[K" << label_ << " [" << std::string(filled, '=')
            << std::string(bar_width - filled, ' ') << "] " << done_;
  if (total_ != 0) std::cerr << '/' << total_;
  std::cerr << std::flush;
  visible_ = true;
}

}  // namespace posevote::cli
