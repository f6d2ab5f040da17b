#include "posevote/feature/surf/team.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#ifdef __linux__
#include <sched.h>
#endif

namespace posevote::surf {
namespace {

TEST(Team, EveryPartIsDoneOnceAndTheNextStepSeesIt) {
  Team team;
  for (const int threads : {1, 2, 3, 8, 2, 1}) {
    std::vector<int> done(1000);
    for (int step = 1; step <= 200; ++step) {
      team.share(threads, 1000, [&](int part, int thread) {
        EXPECT_LT(thread, threads);
        ++done[part];
      });
      ASSERT_EQ(std::ranges::count(done, step), 1000) << threads;
    }
    team.share(threads, 0, [](int, int) { FAIL(); });
  }
}

TEST(Team, NoTwoCallsOfOneThreadOverlap) {
  Team team;
  std::vector<std::atomic<int>> inside(4);
  for (int step = 0; step < 100; ++step)
    team.share(4, 64, [&](int, int thread) {
      EXPECT_EQ(inside[thread].fetch_add(1), 0);
      std::this_thread::yield();
      inside[thread].fetch_sub(1);
    });
}

TEST(Team, AThreadBeginsWithItsOwnStretch) {
  Team team;
  std::array<std::atomic<int>, 2> first = {-1, -1};
  // Nobody goes on before both have begun.
  team.share(2, 100, [&](int part, int thread) {
    int none = -1;
    first[thread].compare_exchange_strong(none, part);
    while (first[0] < 0 || first[1] < 0) std::this_thread::yield();
  });
  EXPECT_EQ(first[0], 0);
  EXPECT_EQ(first[1], 50);
}

TEST(Team, NobodyIsHeldUpByASlowThread) {
  Team team;
  std::atomic<int> done = 0;
  // The thread that begins with the second half stays with its first part until all else is done.
  team.share(2, 100, [&](int part, int) {
    while (part == 50 && done < 99) std::this_thread::yield();
    ++done;
  });
  EXPECT_EQ(done, 100);
}

#ifdef __linux__
// A caller that slept, as one that waits for a camera does: kernels wake the helper beside it.
TEST(Team, HelpersWakeOnAnotherProcessorThanTheCallers) {
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  if (CPU_COUNT(&allowed) < 2) GTEST_SKIP() << "one processor only";
  Team team;
  constexpr int kTurns = 40;
  int apart = 0;
  for (int turn = 0; turn < kTurns; ++turn) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::array<int, 2> processors = {-1, -1};
    std::atomic<int> together = 0;
    team.share(2, 2, [&](int, int thread) {
      processors[thread] = sched_getcpu();
      ++together;
      while (together < 2) std::this_thread::yield();
    });
    apart += processors[0] != processors[1];
  }
  EXPECT_GE(apart, kTurns * 9 / 10);  // the caller may be moved in between
}
#endif

TEST(Team, SeveralThreadsTakePart) {
  Team team;
  std::atomic<int> together = 0;
  // Returns only when two are there at once.
  team.share(2, 2, [&](int, int) {
    ++together;
    while (together < 2) std::this_thread::yield();
  });
  EXPECT_EQ(together, 2);
}

TEST(Team, DoesTheOtherPartsWhenOneThrowsAndPassesTheErrorOn) {
  Team team;
  std::atomic<int> ended = 0;
  const auto work = [&](int part, int) {
    if (part == 2) throw std::runtime_error("broken");
    ++ended;
  };
  EXPECT_THROW(team.share(4, 50, work), std::runtime_error);
  EXPECT_EQ(ended, 49);
  team.share(2, 1, [&](int, int) { ended = 0; });
  EXPECT_EQ(ended, 0);
}

}  // namespace
}  // namespace posevote::surf
