#include "logic/newest_worker.hpp"

#include <gmock/gmock.h>

#include <future>
#include <vector>

namespace posevote::logic {
namespace {

using testing::ElementsAre;

/// A worker that stays in its first item until it is let go.
struct HeldWorker {
  std::promise<void> begun, let_go;
  std::vector<int> items;
  std::vector<std::uint64_t> drops;
  NewestWorker<int> worker{[this](int item, std::uint64_t dropped) {
    items.push_back(item);
    drops.push_back(dropped);
    if (items.size() > 1) return;
    begun.set_value();
    let_go.get_future().wait();
  }};
};

TEST(NewestWorker, DoesEveryItemWhenThereIsTime) {
  std::vector<int> items;
  NewestWorker<int> worker([&](int item, std::uint64_t) { items.push_back(item); });
  for (int i = 0; i < 3; ++i) {
    worker.offer(i);
    worker.wait_until_idle();
  }
  EXPECT_THAT(items, ElementsAre(0, 1, 2));
}

TEST(NewestWorker, TakesTheNewestWhenBusyAndCountsTheRest) {
  HeldWorker held;
  held.worker.offer(1);
  held.begun.get_future().wait();
  for (int i = 2; i <= 30; ++i) held.worker.offer(i);
  held.let_go.set_value();
  held.worker.wait_until_idle();
  EXPECT_THAT(held.items, ElementsAre(1, 30));
  EXPECT_THAT(held.drops, ElementsAre(0, 28));
}

TEST(NewestWorker, FinishesTheItemInHandBeforeItEnds) {
  std::promise<void> begun;
  bool finished = false;
  {
    NewestWorker<int> worker([&](int, std::uint64_t) {
      begun.set_value();
      finished = true;
    });
    worker.offer(1);
    begun.get_future().wait();
  }
  EXPECT_TRUE(finished);
}

TEST(NewestWorker, EndsWithoutAnyItem) {
  NewestWorker<int> worker([](int, std::uint64_t) { FAIL(); });
  worker.wait_until_idle();
}

}  // namespace
}  // namespace posevote::logic
