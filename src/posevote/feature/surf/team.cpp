#include "posevote/feature/surf/team.hpp"

#include <chrono>
#include <utility>

#include "posevote/core/error.hpp"

namespace posevote::surf {
namespace {

constexpr int kBits = 24;
constexpr std::uint64_t kMask = (1 << kBits) - 1;

int next_of(std::uint64_t ticket) {
  return static_cast<int>(ticket & kMask);
}
int parts_of(std::uint64_t ticket) {
  return static_cast<int>(ticket >> kBits & kMask);
}

// Until `value` is no longer `old`.
void await_change(const std::atomic<unsigned>& value, unsigned old) {
  constexpr std::chrono::microseconds kLookOut(100);
  const auto start = std::chrono::steady_clock::now();
  while (value.load(std::memory_order_acquire) == old) {
    if (std::chrono::steady_clock::now() - start < kLookOut)
      std::this_thread::yield();
    else
      value.wait(old, std::memory_order_acquire);
  }
}

}  // namespace

Team::~Team() {
  end_ = true;
  turn_.fetch_add(1, std::memory_order_release);
  turn_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void Team::take_parts(int thread) {
  std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
  while (next_of(ticket) < parts_of(ticket)) {
    if (!ticket_.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel,
                                       std::memory_order_acquire))
      continue;
    try {
      call_(work_, next_of(ticket), thread);
    } catch (...) {
      const std::lock_guard lock(error_mutex_);
      error_ = std::current_exception();
    }
    done_.fetch_add(1, std::memory_order_release);
    ticket = ticket_.load(std::memory_order_acquire);
  }
}

void Team::serve(int thread) {
  for (unsigned turn = 0; !end_;) {
    await_change(turn_, turn);
    turn = turn_.load(std::memory_order_acquire);
    if (thread < threads_.load(std::memory_order_relaxed)) take_parts(thread);
  }
}

void Team::wake(int threads) {
  while (static_cast<int>(helpers_.size()) < threads - 1)
    helpers_.emplace_back(&Team::serve, this, static_cast<int>(helpers_.size()) + 1);
  if (threads < 2) return;
  turn_.fetch_add(1, std::memory_order_release);
  turn_.notify_all();
}

void Team::share_with(int threads, int parts, const void* work, Call call) {
  if (parts < 0 || static_cast<std::uint64_t>(parts) > kMask)
    throw Error(ErrorCode::invalid_argument, "too many parts for a team");
  work_ = work;
  call_ = call;
  threads_.store(threads, std::memory_order_relaxed);
  done_.store(0, std::memory_order_relaxed);
  const std::uint64_t step = (ticket_.load(std::memory_order_relaxed) >> 2 * kBits) + 1;
  ticket_.store(step << 2 * kBits | static_cast<std::uint64_t>(parts) << kBits,
                std::memory_order_release);
  wake(threads);
  take_parts(0);
  while (done_.load(std::memory_order_acquire) < parts) std::this_thread::yield();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

}  // namespace posevote::surf
