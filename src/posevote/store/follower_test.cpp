#include "posevote/store/follower.hpp"

#include <gmock/gmock.h>

#include <condition_variable>

#include "posevote/store/made_views.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"

namespace posevote {
namespace {

const FeatureRecord surf{"surf64 1", "kind=surf\n"};

/// Snapshots as they are handed over.
class Inbox {
 public:
  void put(std::shared_ptr<const ModelSet> models) {
    const std::lock_guard lock(mutex_);
    models_ = std::move(models);
    arrived_.notify_all();
  }
  /// The first snapshot with that many views.
  std::shared_ptr<const ModelSet> wait_for(std::size_t views) {
    std::unique_lock lock(mutex_);
    arrived_.wait(lock, [&] { return models_ && models_->views().size() == views; });
    return models_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::shared_ptr<const ModelSet> models_;
};

class Follow : public testing::Test {
 protected:
  ScratchFolder folder_;
  std::shared_ptr<ObjectStore> here_ = open_sqlite_store(folder_.file("objects.db"));
  std::shared_ptr<ObjectStore> there_ = open_sqlite_store(folder_.file("objects.db"));
  Inbox inbox_;
};

TEST_F(Follow, WhatOthersTeachAndRemoveArrives) {
  const Follower follower(here_, here_->version(), [&](auto models) { inbox_.put(models); });
  there_->add_view("mug", made_view(1), surf);
  const auto first = inbox_.wait_for(1);
  there_->add_view("mug", made_view(2), surf);
  const auto second = inbox_.wait_for(2);
  EXPECT_EQ(first->views()[0].view, second->views()[0].view);  // not loaded again
  there_->remove_object("mug");
  EXPECT_TRUE(inbox_.wait_for(0)->objects().empty());
}

TEST_F(Follow, AnOldVersionIsMadeUpForAtOnce) {
  const std::int64_t before = here_->version();
  there_->add_view("mug", made_view(1), surf);
  const Follower follower(here_, before, [&](auto models) { inbox_.put(models); });
  EXPECT_EQ(inbox_.wait_for(1)->objects()[0].name, "mug");
}

TEST_F(Follow, AFailedAttemptIsToldAndRepeated) {
  std::atomic<bool> refuse = true;
  const Follower follower(here_, here_->version(), [&](auto models) {
    if (refuse) throw Error(ErrorCode::feature_mismatch, "not these");
    inbox_.put(models);
  });
  there_->add_view("mug", made_view(1), surf);
  while (follower.problem().empty()) std::this_thread::yield();
  EXPECT_EQ(follower.problem(), "not these");
  refuse = false;
  inbox_.wait_for(1);
  while (follower.version() != there_->version()) std::this_thread::yield();
  while (!follower.problem().empty()) std::this_thread::yield();
}

TEST_F(Follow, WithoutChangesNothingIsHandedOver) {
  here_->add_view("mug", made_view(1), surf);
  std::atomic<int> swaps = 0;
  {
    const Follower follower(here_, here_->version(), [&](const auto&) { ++swaps; });
    EXPECT_FALSE(there_->wait_for_change(there_->version(), std::chrono::milliseconds(300)));
  }
  EXPECT_EQ(swaps, 0);
}

}  // namespace
}  // namespace posevote
