// A few threads that work through the same steps together.
#pragma once

#include <barrier>
#include <exception>
#include <thread>
#include <vector>

namespace posevote::surf {

/// One member of a team: which part is its own, and where it waits for the others.
class Member {
 public:
  Member(int index, int count, std::barrier<>* barrier)
      : index_(index), count_(count), barrier_(barrier) {}

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
    if (barrier_) barrier_->arrive_and_wait();
  }

 private:
  int index_, count_;
  std::barrier<>* barrier_;
};

/// Runs `work(member)` on `count` threads, one of them the caller's. `work` must not throw past its
/// own waits: a member that leaves early lets the others go on without it.
template <class Work>
void run_team(int count, const Work& work) {
  if (count <= 1) return work(Member(0, 1, nullptr));
  std::barrier<> barrier(count);
  std::vector<std::exception_ptr> errors(count);
  const auto run = [&](int index) {
    try {
      work(Member(index, count, &barrier));
    } catch (...) {
      errors[index] = std::current_exception();
      barrier.arrive_and_drop();
    }
  };
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < count; ++i) others.emplace_back(run, i);
    run(0);
  }
  for (const auto& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace posevote::surf
