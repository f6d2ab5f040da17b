// A few threads that work through the same steps together.
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <thread>
#include <vector>

namespace posevote::surf {

/// Where the members of a team wait for each other. Looks out for the others for some
/// microseconds before it sleeps: being woken takes as long as a step on a small picture.
class Meeting {
 public:
  void reset(int count);
  /// Returns when all have come here.
  void arrive_and_wait();
  /// Comes here for the last time; the others go on without this one.
  void arrive_and_drop();

 private:
  bool arrive();
  std::atomic<int> count_ = 1, missing_ = 1;
  std::atomic<unsigned> round_ = 0;
};

/// One member of a team: which part is its own, and where it waits for the others.
class Member {
 public:
  Member(int index, int count, Meeting* meeting)
      : index_(index), count_(count), meeting_(meeting) {}

  [[nodiscard]] int index() const noexcept { return index_; }
  [[nodiscard]] int count() const noexcept { return count_; }
  /// First index of the part number `part` (0 ... count) of [0, total).
  [[nodiscard]] int begin_of(int part, int total) const noexcept {
    return static_cast<int>(static_cast<long long>(total) * part / count_);
  }
  [[nodiscard]] int begin(int total) const noexcept { return begin_of(index_, total); }
  [[nodiscard]] int end(int total) const noexcept { return begin_of(index_ + 1, total); }
  /// Returns when all members have come here.
  void wait() const {
    if (count_ > 1) meeting_->arrive_and_wait();
  }

 private:
  int index_, count_;
  Meeting* meeting_;
};

/// Keeps its threads, asleep, from one call to the next. One caller at a time.
class Team {
 public:
  Team() = default;
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  ~Team();

  /// Runs `work(member)` on `count` threads, one of them the caller's, and returns when all have
  /// ended. When `work` throws, the others go on without that member, and one of the exceptions is
  /// thrown here.
  template <class Work>
  void run(int count, const Work& work) {
    if (count <= 1) return work(Member(0, 1, nullptr));
    run_on(count, &work,
           [](const void* of, const Member& member) { (*static_cast<const Work*>(of))(member); });
  }

 private:
  using Call = void (*)(const void* work, const Member& member);
  struct Helper {
    std::atomic<unsigned> turn = 0;  // one more: there is work
    bool end = false;
    std::exception_ptr error;
    std::thread thread;
  };

  void run_on(int count, const void* work, Call call);
  std::exception_ptr take_part(int index);
  void serve(Helper& helper, int index);

  std::vector<std::unique_ptr<Helper>> helpers_;
  Meeting meeting_;
  std::atomic<int> working_ = 0;
  int count_ = 0;
  const void* work_ = nullptr;
  Call call_ = nullptr;
};

}  // namespace posevote::surf
