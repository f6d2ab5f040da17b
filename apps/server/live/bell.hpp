// Tells waiting threads that something has changed.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace posevote::server {

/// Safe for many threads.
class Bell {
 public:
  void ring() {
    {
      const std::lock_guard lock(mutex_);
      ++rings_;
    }
    changed_.notify_all();
  }

  [[nodiscard]] std::uint64_t rings() const {
    const std::lock_guard lock(mutex_);
    return rings_;
  }

  /// Waits until there were other than `seen` rings, at most `time`; returns how many there were.
  std::uint64_t wait(std::uint64_t seen, std::chrono::milliseconds time) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, time, [&] { return rings_ != seen; });
    return rings_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::uint64_t rings_ = 0;
};

}  // namespace posevote::server
