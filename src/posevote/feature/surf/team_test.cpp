#include "posevote/feature/surf/team.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace posevote::surf {
namespace {

TEST(Team, EveryMemberHasItsPartAndSeesTheOthersAfterTheWait) {
  Team team;
  for (const int count : {1, 2, 3, 8, 2, 1}) {
    std::vector<int> done(1000);
    std::vector<int> sums(count);
    team.run(count, [&](const Member& member) {
      EXPECT_EQ(member.count(), count);
      for (int round = 0; round < 50; ++round) {
        for (int i = member.begin(1000); i < member.end(1000); ++i) ++done[i];
        member.wait();
        int sum = 0;
        for (const int value : done) sum += value;
        EXPECT_EQ(sum, 1000 * (round + 1));
        member.wait();
      }
      sums[member.index()] = 1;
    });
    EXPECT_EQ(std::vector<int>(count, 1), sums);
  }
}

TEST(Team, GoesOnWithoutAMemberThatThrowsAndPassesTheErrorOn) {
  Team team;
  for (const int thrower : {0, 2}) {
    std::atomic<int> ended = 0;
    const auto work = [&](const Member& member) {
      member.wait();
      if (member.index() == thrower) throw std::runtime_error("broken");
      member.wait();
      member.wait();
      ++ended;
    };
    EXPECT_THROW(team.run(4, work), std::runtime_error);
    EXPECT_EQ(ended, 3);
  }
  int calls = 0;
  team.run(2, [&](const Member& member) { calls += member.index() == 0; });
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace posevote::surf
