// A few threads that share the parts of one step after another.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace posevote::surf {

/// Keeps its threads, asleep, from one call to the next. One caller at a time.
///
/// Every thread begins with a stretch of the parts of its own, the same in every step: what it has
/// written lies in its cache. Who is done takes from the ends of the others' stretches, so that a
/// thread that wakes late, or gets no processor, holds nobody up. Between two steps threads look
/// out for work for some microseconds before they sleep: being woken takes as long as a step on a
/// small picture.
class Team {
 public:
  static constexpr int kMost = 64;

  Team() = default;
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  ~Team();

  /// Wakes the threads for calls of `share` that follow soon.
  void wake(int threads);

  /// Calls `work(part, thread)` once for every part in [0, parts), at most 2^24, and returns when
  /// all have returned: on at most `threads` <= kMost threads, one of them the caller's, in any
  /// order. No two calls with the same `thread` in [0, threads) overlap. When calls throw, the
  /// others are made all the same, and one of the exceptions is thrown here.
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
    constexpr int kLeast = 16;
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
  void make_room();
  void serve(int thread);
  void take_parts(int thread);
  void do_part(int part, int thread);

  // Parts that nobody has begun: the number of the step, the end and the beginning, in one: 16, 24
  // and 24 bits. Only who has taken a part may look at `work_` and `call_`, for until it is done
  // they stay.
  struct alignas(64) Stretch {
    std::atomic<std::uint64_t> ticket = 0;
  };
  struct alignas(64) Count {
    std::atomic<int> parts = 0;
  };
  [[nodiscard]] int count_done() const;

  std::array<Stretch, kMost> stretches_;
  std::array<Count, kMost> done_;  // by thread
  std::uint64_t step_ = 0;
  std::atomic<int> threads_ = 0;
  std::atomic<unsigned> turn_ = 0;  // one more: there is something to do
  std::atomic<bool> end_ = false;
  const void* work_ = nullptr;
  Call call_ = nullptr;
  std::mutex error_mutex_;
  std::exception_ptr error_;
  std::vector<std::thread> helpers_;
  int processor_ = -1;  // the caller's, when room was made
};

}  // namespace posevote::surf
