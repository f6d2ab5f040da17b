#include "posevote/evaluate/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

namespace posevote {
namespace {

TEST(ParallelFor, CallsEveryTurnOnce) {
  for (const int jobs : {0, 1, 3, 16}) {
    std::vector<int> calls(100);
    parallel_for(calls.size(), jobs, [&](std::size_t i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(100, 1)) << jobs;
  }
}

TEST(ParallelFor, CountsProgressUpToTheEnd) {
  std::vector<std::size_t> seen;
  parallel_for(
      20, 4, [](std::size_t) {},
      [&](std::size_t done, std::size_t total) {
        EXPECT_EQ(total, 20U);
        seen.push_back(done);
      });
  ASSERT_EQ(seen.size(), 20U);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i + 1);
}

TEST(ParallelFor, DoesNothingForNothing) {
  parallel_for(0, 4, [](std::size_t) { FAIL(); });
}

TEST(ParallelFor, HandsOnAnExceptionAndBeginsNoNewTurns) {
  std::atomic<int> calls{0};
  const auto work = [&](std::size_t i) {
    ++calls;
    if (i == 3) throw std::runtime_error(std::to_string(i));
  };
  EXPECT_THROW(parallel_for(1000, 1, work), std::runtime_error);
  EXPECT_EQ(calls, 4);
  EXPECT_THROW(parallel_for(1000, 4, work), std::runtime_error);
}

TEST(ThreadCount, IsAtLeastOne) {
  EXPECT_GE(thread_count(0), 1);
  EXPECT_EQ(thread_count(7), 7);
}

}  // namespace
}  // namespace posevote
