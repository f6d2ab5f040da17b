// Two databases that were changed one without the other, and one that several machines share.
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <thread>

#include "posevote/json/recognition_json.hpp"
#include "posevote/store/made_views.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"
#include "posevote/store/sync.hpp"
#include "program.hpp"

namespace posevote {
namespace {

const FeatureRecord features = record_features({});

class SyncCommand : public Program {
 protected:
  SyncCommand() {
    for (int i = 0; i < 40; ++i) {
      (i % 2 ? here_ : there_)->add_view("mug", made_view(i, 400), features);
      if (i % 5 == 0) (i % 2 ? there_ : here_)->add_view("mug", made_view(i, 400), features);
    }
  }
  [[nodiscard]] static std::vector<ViewKey> keys(const ObjectStore& store) {
    std::vector<ViewKey> keys;
    for (const KnownView& view : list_views(store)) keys.push_back(view.key);
    return keys;
  }
  [[nodiscard]] Json json_of(const std::vector<std::string>& arguments) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Json::parse(outcome.lines().at(0));
  }

  const std::string other_ = path("there.db");
  std::unique_ptr<ObjectStore> here_ = open_sqlite_store(database());
  std::unique_ptr<ObjectStore> there_ = open_sqlite_store(other_);
};

TEST_F(SyncCommand, DiffSaysWhatSyncThenDoes) {
  const Json difference = json_of({"objects", "diff", database(), other_, "--json"});
  EXPECT_EQ(difference["only_a"].size(), 16U);
  EXPECT_EQ(difference["only_b"].size(), 16U);
  EXPECT_EQ(difference["in_both"], 8);
  EXPECT_EQ(difference["only_a"][0]["version"], "1.2.3");
  const Json done = json_of({"sync", other_, "--json"});
  EXPECT_EQ(done["sent"], difference["only_a"]);
  EXPECT_EQ(done["received"], difference["only_b"]);
  EXPECT_EQ(keys(*here_), keys(*there_));
  EXPECT_EQ(json_of({"sync", other_, "--json"})["in_both"], 40);
}

TEST_F(SyncCommand, MergeAddsAndLeavesTheSourceAlone) {
  const auto before = keys(*there_);
  const Json done = json_of({"objects", "merge", other_, "--json"});
  EXPECT_EQ(done["added"].size(), 16U);
  EXPECT_EQ(keys(*there_), before);
  EXPECT_EQ(keys(*here_).size(), 40U);
}

TEST_F(SyncCommand, KilledAtAnyMomentItIsSimplyRunAgain) {
  const std::size_t begun = keys(*here_).size() + keys(*there_).size();
  std::size_t known = begun;
  for (std::size_t i = 1; i < 6; ++i) {
    const pid_t child = start({"sync", other_});
    bool ended = false;
    while (!ended && keys(*here_).size() + keys(*there_).size() < begun + 6 * i)
      ended = waitpid(child, nullptr, WNOHANG) != 0;
    if (!ended) {
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
    EXPECT_GE(keys(*here_).size() + keys(*there_).size(), known) << "something was lost";
    known = keys(*here_).size() + keys(*there_).size();
  }
  EXPECT_EQ(run({"sync", other_}).status, 0);
  EXPECT_EQ(keys(*here_), keys(*there_));
  EXPECT_EQ(keys(*here_).size(), 40U);
}

TEST_F(SyncCommand, KilledAmongRemovalsAndRenamesItIsSimplyRunAgain) {
  for (int i = 100; i < 110; ++i) here_->add_view("jug", made_view(i, 400), features);
  ASSERT_EQ(run({"sync", other_}).status, 0);
  here_->rename_object("mug", "pot");
  for (int i = 0; i < 10; ++i) here_->remove_view("pot", here_->views("pot").front().id);
  for (int i = 0; i < 5; ++i) there_->remove_view("jug", there_->views("jug").front().id);
  for (int i = 50; i < 60; ++i)
    (i % 2 ? here_ : there_)->add_view("cup", made_view(i, 400), features);
  const std::vector<ViewKey> jugs_there = keys(*there_);
  std::vector<ViewKey> wanted;
  for (const ViewKey& key : keys(*here_))
    if (key.object != "jug" || std::ranges::find(jugs_there, key) != jugs_there.end())
      wanted.push_back(key);
  for (const ViewKey& key : keys(*there_))
    if (key.object == "cup") wanted.push_back(key);
  std::sort(wanted.begin(), wanted.end());
  EXPECT_EQ(wanted.size(), 45U);  // 30 pots, 5 jugs, 10 cups

  const auto changes = [&] { return here_->version() + there_->version(); };
  int killed = 0;
  for (bool ended = false; !ended;) {
    const std::int64_t before = changes();
    const pid_t child = start({"sync", other_});
    while (!ended && changes() < before + 7) ended = waitpid(child, nullptr, WNOHANG) != 0;
    if (ended) break;
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    ++killed;
  }
  EXPECT_GT(killed, 2);
  EXPECT_EQ(run({"sync", other_}).status, 0);
  EXPECT_EQ(keys(*here_), wanted);
  EXPECT_EQ(keys(*there_), wanted);
  EXPECT_EQ(json_of({"sync", other_, "--json"})["in_both"], 45);
}

TEST_F(SyncCommand, WhatCannotBeOpenedIsSaidAndNothingIsChanged) {
  const auto before = keys(*here_);
  expect_failure(run({"sync", path("nothing.db")}), 1, {"nothing.db"});
  expect_failure(run({"sync", "postgresql://robot:secret@127.0.0.1:1/db"}), 1, {"robot:***@"});
  expect_failure(run({"objects", "diff", database(), path("nothing.db")}), 1, {"nothing.db"});
  EXPECT_EQ(keys(*here_), before);
}

}  // namespace
}  // namespace posevote
