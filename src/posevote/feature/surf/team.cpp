#include "posevote/feature/surf/team.hpp"

#include <chrono>
#include <utility>
#ifdef __linux__
#include <pthread.h>
#include <sched.h>
#endif

#include "posevote/core/error.hpp"

namespace posevote::surf {
namespace {

constexpr int kBits = 24;
constexpr std::uint64_t kMask = (1 << kBits) - 1;

int begin_of(std::uint64_t ticket) {
  return static_cast<int>(ticket & kMask);
}
int end_of(std::uint64_t ticket) {
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
  turn_.fetch_add(1);
  turn_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void Team::do_part(int part, int thread) {
  try {
    call_(work_, part, thread);
  } catch (...) {
    const std::lock_guard lock(error_mutex_);
    error_ = std::current_exception();
  }
  done_[static_cast<std::size_t>(thread)].parts.fetch_add(1, std::memory_order_release);
}

int Team::count_done() const {
  int sum = 0;
  for (int thread = 0; thread < threads_.load(std::memory_order_relaxed); ++thread)
    sum += done_[static_cast<std::size_t>(thread)].parts.load(std::memory_order_acquire);
  return sum;
}

// Of the own stretch the first part, of another's the last. A thread that comes late may be one too
// many for the step that it finds: what it reads after a ticket is no older than the ticket.
void Team::take_parts(int thread) {
  const int threads = threads_.load(std::memory_order_relaxed);
  for (int i = 0; i < threads; ++i) {
    auto& stretch = stretches_[static_cast<std::size_t>((thread + i) % threads)].ticket;
    std::uint64_t ticket = stretch.load(std::memory_order_acquire);
    while (begin_of(ticket) < end_of(ticket) && thread < threads_.load(std::memory_order_relaxed)) {
      const std::uint64_t rest = i == 0 ? ticket + 1 : ticket - (std::uint64_t{1} << kBits);
      if (!stretch.compare_exchange_weak(ticket, rest, std::memory_order_acq_rel,
                                         std::memory_order_acquire))
        continue;
      do_part(i == 0 ? begin_of(ticket) : end_of(rest), thread);
      ticket = stretch.load(std::memory_order_acquire);
    }
  }
}

void Team::serve(int thread) {
  for (unsigned turn = 0; !end_;) {
    await_change(turn_, turn);
    turn = turn_.load(std::memory_order_acquire);
    take_parts(thread);
  }
}

void Team::wake(int threads) {
  if (threads < 2) return;
  if (static_cast<int>(helpers_.size()) < threads - 1) processor_ = -1;
  while (static_cast<int>(helpers_.size()) < threads - 1)
    helpers_.emplace_back(&Team::serve, this, static_cast<int>(helpers_.size()) + 1);
  make_room();
  turn_.fetch_add(1);
  turn_.notify_all();
}

// A kernel likes to wake a thread on the processor of the one that wakes it, where it waits until
// that one has done all alone: the helpers may use all processors that the caller may, but its own.
void Team::make_room() {
#ifdef __linux__
  const int here = sched_getcpu();
  if (here < 0 || here == processor_) return;
  processor_ = here;
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0 || CPU_COUNT(&allowed) < 2) return;
  CPU_CLR(here, &allowed);
  for (std::thread& helper : helpers_)
    pthread_setaffinity_np(helper.native_handle(), sizeof allowed, &allowed);
#endif
}

void Team::share_with(int threads, int parts, const void* work, Call call) {
  if (threads > kMost || parts < 0 || static_cast<std::uint64_t>(parts) > kMask)
    throw Error(ErrorCode::invalid_argument, "too many threads or parts for a team");
  work_ = work;
  call_ = call;
  threads_.store(threads, std::memory_order_relaxed);
  for (int thread = 0; thread < threads; ++thread)
    done_[static_cast<std::size_t>(thread)].parts.store(0, std::memory_order_relaxed);
  ++step_;
  const auto end = [&](int thread) {
    return static_cast<std::uint64_t>(parts) * thread / static_cast<std::uint64_t>(threads);
  };
  for (int thread = 0; thread < threads; ++thread)
    stretches_[static_cast<std::size_t>(thread)].ticket.store(
        step_ << 2 * kBits | end(thread + 1) << kBits | end(thread), std::memory_order_release);
  wake(threads);
  take_parts(0);
  while (count_done() < parts) std::this_thread::yield();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

}  // namespace posevote::surf
