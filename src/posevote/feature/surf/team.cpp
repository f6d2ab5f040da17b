#include "posevote/feature/surf/team.hpp"

#include <chrono>

namespace posevote::surf {
namespace {

// Until `value` is no longer `old`.
template <class T>
void await_change(const std::atomic<T>& value, T old) {
  constexpr std::chrono::microseconds kLookOut(50);
  const auto start = std::chrono::steady_clock::now();
  while (value.load(std::memory_order_acquire) == old) {
    if (std::chrono::steady_clock::now() - start > kLookOut) {
      value.wait(old, std::memory_order_acquire);
      continue;
    }
    std::this_thread::yield();
  }
}

}  // namespace

void Meeting::reset(int count) {
  count_ = count;
  missing_ = count;
}

// True for the last one, who lets the others go.
bool Meeting::arrive() {
  if (missing_.fetch_sub(1, std::memory_order_acq_rel) > 1) return false;
  missing_.store(count_.load(std::memory_order_relaxed), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_acq_rel);
  round_.notify_all();
  return true;
}

void Meeting::arrive_and_wait() {
  const unsigned round = round_.load(std::memory_order_relaxed);
  if (!arrive()) await_change(round_, round);
}

void Meeting::arrive_and_drop() {
  count_.fetch_sub(1, std::memory_order_acq_rel);
  arrive();
}

Team::~Team() {
  for (const auto& helper : helpers_) {
    helper->end = true;
    helper->turn.fetch_add(1, std::memory_order_release);
    helper->turn.notify_one();
    helper->thread.join();
  }
}

std::exception_ptr Team::take_part(int index) {
  try {
    call_(work_, Member(index, count_, &meeting_));
    return nullptr;
  } catch (...) {
    meeting_.arrive_and_drop();
    return std::current_exception();
  }
}

void Team::serve(Helper& helper, int index) {
  for (unsigned turn = 0;; ++turn) {
    helper.turn.wait(turn, std::memory_order_acquire);
    if (helper.end) return;
    helper.error = take_part(index);
    if (working_.fetch_sub(1, std::memory_order_acq_rel) == 1) working_.notify_one();
  }
}

void Team::run_on(int count, const void* work, Call call) {
  while (static_cast<int>(helpers_.size()) < count - 1) {
    auto helper = std::make_unique<Helper>();
    helper->thread =
        std::thread(&Team::serve, this, std::ref(*helper), static_cast<int>(helpers_.size()) + 1);
    helpers_.push_back(std::move(helper));
  }
  count_ = count;
  work_ = work;
  call_ = call;
  meeting_.reset(count);
  working_ = count - 1;
  for (int i = 0; i < count - 1; ++i) {
    helpers_[i]->turn.fetch_add(1, std::memory_order_release);
    helpers_[i]->turn.notify_one();
  }
  std::exception_ptr error = take_part(0);
  for (int left = working_; left > 0; left = working_) await_change(working_, left);
  for (int i = 0; i < count - 1; ++i)
    if (!error) error = helpers_[i]->error;
  if (error) std::rethrow_exception(error);
}

}  // namespace posevote::surf
