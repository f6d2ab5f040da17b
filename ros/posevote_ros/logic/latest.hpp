// The newest item, for those who wait for the next one.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>

namespace posevote::logic {

/// Safe to use from many threads; every waiting thread gets each new item, or newer ones.
template <class Item>
class Latest {
 public:
  void offer(Item item) {
    {
      const std::lock_guard lock(mutex_);
      item_ = std::move(item);
      ++number_;
    }
    changed_.notify_all();
  }

  /// Number of the newest item; 0: none yet.
  [[nodiscard]] std::uint64_t number() const {
    const std::lock_guard lock(mutex_);
    return number_;
  }

  /// The newest item after number `seen`, which becomes its number; empty when none comes in time.
  [[nodiscard]] std::optional<Item> wait_newer(std::uint64_t& seen,
                                               std::chrono::duration<double> timeout) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, timeout, [&] { return number_ > seen; })) return std::nullopt;
    seen = number_;
    return item_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Item> item_;
  std::uint64_t number_ = 0;
};

}  // namespace posevote::logic
