// Events per second over the last few seconds.
#pragma once

#include <deque>
#include <mutex>

namespace posevote {

/// Safe for many threads. Times are seconds on any one clock.
class RateMeter {
 public:
  void count(double now_s) {
    const std::lock_guard lock(mutex_);
    times_.push_back(now_s);
    forget(now_s);
  }

  [[nodiscard]] double per_second(double now_s) {
    const std::lock_guard lock(mutex_);
    forget(now_s);
    if (times_.size() < 2) return 0;
    return static_cast<double>(times_.size() - 1) / (now_s - times_.front());
  }

 private:
  void forget(double now_s) {
    while (!times_.empty() && times_.front() < now_s - kWindow) times_.pop_front();
  }

  static constexpr double kWindow = 3;
  std::mutex mutex_;
  std::deque<double> times_;
};

}  // namespace posevote
