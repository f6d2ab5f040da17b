// A few threads that share the parts of one step after another.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace posevote::surf {

/// Keeps its threads, asleep, from one call to the next. One caller at a time.
///
/// Whoever has time takes the next part: a thread that wakes late, or gets no processor, holds
/// nobody up. Between two steps threads look out for work for some microseconds before they sleep:
/// being woken takes as long as a step on a small picture.
class Team {
 public:
  Team() = default;
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  ~Team();

  /// Wakes the threads for calls of `share` that follow soon.
  void wake(int threads);

  /// Calls `work(part, thread)` once for every part in [0, parts), at most 2^24, and returns when
  /// all have returned. Parts are begun in ascending order, on at most `threads` threads, one of
  /// them the caller's; no two calls with the same `thread` in [0, threads) overlap. When calls
  /// throw, the others are made all the same, and one of the exceptions is thrown here.
  template <class Work>
  void share(int threads, int parts, const Work& work) {
    if (threads > 1) {
      share_with(threads, parts, &work, [](const void* of, int part, int thread) {
        (*static_cast<const Work*>(of))(part, thread);
      });
      return;
    }
    for (int part = 0; part < parts; ++part) work(part, 0);
  }

  /// Calls `work(begin, end)` for ranges that make up [0, total).
  template <class Work>
  void share_ranges(int threads, int total, const Work& work) {
    constexpr int kLeast = 32;
    if (threads == 1) return work(0, total);
    const int parts = std::clamp(total / kLeast, std::min(total, 1), 16 * threads);
    const auto begin = [&](int part) {
      return static_cast<int>(static_cast<std::int64_t>(total) * part / parts);
    };
    share(threads, parts, [&](int part, int) { work(begin(part), begin(part + 1)); });
  }

 private:
  using Call = void (*)(const void* work, int part, int thread);

  void share_with(int threads, int parts, const void* work, Call call);
  void serve(int thread);
  void take_parts(int thread);

  // The number of the step, of its parts and of the next part, in one: 16, 24 and 24 bits. Only who
  // has taken a part may look at `work_` and `call_`, for until it is done they stay.
  std::atomic<std::uint64_t> ticket_ = 0;
  std::atomic<int> done_ = 0, threads_ = 0;
  std::atomic<unsigned> turn_ = 0;  // one more: there is something to do
  std::atomic<bool> end_ = false;
  const void* work_ = nullptr;
  Call call_ = nullptr;
  std::mutex error_mutex_;
  std::exception_ptr error_;
  std::vector<std::thread> helpers_;
};

}  // namespace posevote::surf
