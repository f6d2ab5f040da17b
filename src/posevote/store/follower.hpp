// Keeps whoever recognises up to date with a database that others teach into.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "posevote/store/object_store.hpp"

namespace posevote {

/// Waits for changes of a store in a thread of its own, loads what has changed, and hands the new
/// snapshot over. Recognition goes on with the old one until then, and as long as the database
/// cannot be reached.
class Follower {
 public:
  /// Called in the follower's thread; what it throws as Error counts as a failed attempt.
  using Swap = std::function<void(std::shared_ptr<const ModelSet>)>;

  /// `known`: the store's version when the snapshot in use was loaded, or an older one.
  Follower(std::shared_ptr<const ObjectStore> store, std::int64_t known, Swap swap,
           const LoadOptions& options = {});
  /// Waits for the attempt in hand.
  ~Follower();
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

  /// Why the last attempt failed; "" when it did not.
  [[nodiscard]] std::string problem() const;
  /// Version that was handed over last.
  [[nodiscard]] std::int64_t version() const noexcept { return known_; }

 private:
  void run();
  void attempt();

  std::shared_ptr<const ObjectStore> store_;
  Swap swap_;
  LoadOptions options_;
  std::atomic<std::int64_t> known_;
  std::atomic<bool> stop_ = false;
  mutable std::mutex mutex_;
  std::string problem_;
  std::thread thread_;
};

}  // namespace posevote
