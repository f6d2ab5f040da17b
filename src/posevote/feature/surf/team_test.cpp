#include "posevote/feature/surf/team.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

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

TEST(Team, PartsAreBegunInOrder) {
  Team team;
  std::atomic<int> begun = 0;
  // A part may wait for the one before: somebody works on that already.
  team.share(3, 100, [&](int part, int) {
    while (begun < part) std::this_thread::yield();
    ++begun;
  });
  EXPECT_EQ(begun, 100);
}

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
