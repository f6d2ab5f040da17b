#include "logic/latest.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace posevote::logic {
namespace {

constexpr std::chrono::hours long_enough{1};

TEST(Latest, GivesTheNewestItemOnce) {
  Latest<int> latest;
  latest.offer(1);
  latest.offer(2);
  std::uint64_t seen = 0;
  EXPECT_EQ(latest.wait_newer(seen, long_enough), 2);
  EXPECT_EQ(seen, 2u);
  EXPECT_FALSE(latest.wait_newer(seen, std::chrono::seconds(0)));
}

TEST(Latest, PassesOverWhatIsOlderThanTheQuestion) {
  Latest<int> latest;
  latest.offer(1);
  std::uint64_t seen = latest.number();
  std::thread camera([&] { latest.offer(2); });
  EXPECT_EQ(latest.wait_newer(seen, long_enough), 2);
  camera.join();
}

TEST(Latest, GivesUpWhenNothingComes) {
  Latest<int> latest;
  std::uint64_t seen = 0;
  EXPECT_FALSE(latest.wait_newer(seen, std::chrono::milliseconds(1)));
  EXPECT_EQ(seen, 0u);
}

}  // namespace
}  // namespace posevote::logic
