// A slow worker behind a fast source: always the newest item, never a queue.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace posevote::logic {

/// Runs `work` on a thread of its own. `offer` never waits for it: an item that comes while the
/// worker is busy waits, and is dropped when a newer one comes. So a result is never older than the
/// item in hand plus one. Safe to use from many threads.
template <class Item>
class NewestWorker {
 public:
  /// `work(item, dropped)`: `dropped` items were passed over since the last call. Must not throw.
  using Work = std::function<void(Item item, std::uint64_t dropped)>;

  explicit NewestWorker(Work work) : work_(std::move(work)), thread_([this] { run(); }) {}

  /// Waits for the item in hand; the one that waits is given up.
  ~NewestWorker() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  NewestWorker(const NewestWorker&) = delete;
  NewestWorker& operator=(const NewestWorker&) = delete;

  void offer(Item item) {
    {
      const std::lock_guard lock(mutex_);
      if (waiting_) ++dropped_;
      waiting_ = std::move(item);
    }
    changed_.notify_all();
  }

  /// Returns when nothing waits and nothing is in hand.
  void wait_until_idle() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !waiting_ && !busy_; });
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return stopped_ || waiting_; });
      if (stopped_) return;
      Item item = std::move(*waiting_);
      waiting_.reset();
      const std::uint64_t dropped = std::exchange(dropped_, 0);
      busy_ = true;
      lock.unlock();
      work_(std::move(item), dropped);
      lock.lock();
      busy_ = false;
      changed_.notify_all();
    }
  }

  Work work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Item> waiting_;
  std::uint64_t dropped_ = 0;
  bool busy_ = false, stopped_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace posevote::logic
