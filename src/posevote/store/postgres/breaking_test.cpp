// A connection that breaks between any two messages, and within one, of everything that a store
// does.
#include <gmock/gmock.h>

#include "posevote/store/postgres/postgres_store.hpp"
#include "posevote/store/postgres/relay.hpp"
#include "posevote/store/postgres/test_server.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"
#include "posevote/store/sync.hpp"
#include "posevote/store/transfer.hpp"

namespace posevote::postgres {
namespace {

const FeatureRecord surf{"surf64 1", "kind=surf\n"};

class BreakAnywhere : public ServerTest {
 protected:
  void SetUp() override {
    ServerTest::SetUp();
    if (IsSkipped()) return;
    relay_ = std::make_unique<Relay>(server_.socket_path());
    direct_ = open_postgres_store(server_.address(database_));
  }
  void TearDown() override {
    relay_.reset();
    ServerTest::TearDown();
  }

  std::unique_ptr<ObjectStore> by_relay() const {
    return open_postgres_store(relay_->address(database_));
  }

  /// What the database holds, as text.
  static std::string state(const ObjectStore& store) {
    std::string text = "note " + store.note("a") + "\n";
    for (const KnownView& view : list_views(store))
      text += view.key.object + " " + view.key.identity + " " + view.hash + "\n";
    return text;
  }

  /// The same objects each time.
  void fill() const {
    direct_->transact([&] {
      for (const ObjectSummary& object : direct_->list()) direct_->remove_object(object.name);
      for (const ImpostorSummary& impostor : direct_->impostors())
        direct_->remove_impostor(impostor.id);
      direct_->set_note("a", "");
      for (int i = 0; i < 3; ++i) direct_->add_view("mug", made_view(i, 300), surf);
      direct_->add_view("cup", made_view(3), surf);
    });
  }

  /// Cuts `change` short after 0, 1, 2, ... messages, until it comes to its end without a cut.
  void expect_all_or_nothing(const std::function<void(ObjectStore&)>& change) const {
    fill();
    const std::string before = state(*direct_);
    change(*direct_);
    const std::string after = state(*direct_);
    EXPECT_NE(after, before);
    for (int messages = 0;; ++messages) {
      fill();
      const auto store = by_relay();
      relay_->cut_after(messages);
      const std::string error = error_of([&] { change(*store); });
      const bool cut = relay_->end_cut();
      EXPECT_EQ(state(*store), state(*direct_));  // it goes on
      if (error.empty())
        EXPECT_EQ(state(*direct_), after);
      else
        EXPECT_THAT(state(*direct_), testing::AnyOf(before, after)) << error;
      EXPECT_THAT(error, testing::AnyOf("", testing::StartsWith("io: database")));
      if (cut) continue;
      EXPECT_EQ(error, "");
      EXPECT_GT(messages, 1);
      return;
    }
  }

  /// The same of something that reads: nobody notices.
  void expect_unnoticed(const std::function<void(const ObjectStore&)>& read) const {
    fill();
    bool cut = true;
    for (int messages = 0; cut; ++messages) {
      const auto store = by_relay();
      relay_->cut_after(messages);
      EXPECT_EQ(error_of([&] { read(*store); }), "");
      cut = relay_->end_cut();
    }
  }

  std::unique_ptr<Relay> relay_;
  std::unique_ptr<ObjectStore> direct_;
};

TEST_F(BreakAnywhere, EveryChangeIsAllOrNothing) {
  const std::vector<std::function<void(ObjectStore&)>> changes{
      [](ObjectStore& s) { s.add_view("mug", made_view(7, 300), surf); },
      [](ObjectStore& s) { s.remove_view("mug", s.views("mug").front().id); },
      [](ObjectStore& s) { s.remove_object("mug"); },
      [](ObjectStore& s) { s.rename_object("mug", "pot"); },
      [](ObjectStore& s) {
        s.add_impostor({"", made_features(9), {1, 2, 3}, {}}, surf);
      },
      [](ObjectStore& s) { s.set_note("a", "b"); },
      [](ObjectStore& s) {
        s.rebuild(surf, [](const auto&, const auto&) { return made_features(8); });
      },
      [](ObjectStore& s) {
        s.transact([&] {
          s.remove_object("cup");
          s.add_view("pot", made_view(8), surf);
        });
      }};
  for (const auto& change : changes) expect_all_or_nothing(change);
}

TEST_F(BreakAnywhere, ReadingIsDoneAgain) {
  const std::vector<std::function<void(const ObjectStore&)>> readings{
      [](const ObjectStore& s) { EXPECT_EQ(s.list().size(), 2U); },
      [](const ObjectStore& s) { EXPECT_EQ(s.load()->views().size(), 4U); },
      [](const ObjectStore& s) {
        EXPECT_EQ(s.view("cup", s.views("cup")[0].id).view.features.size(), 5U);
      },
      [](const ObjectStore& s) { EXPECT_GT(s.version(), 0); },
      [](const ObjectStore& s) { EXPECT_TRUE(s.impostors().empty()); }};
  for (const auto& read : readings) expect_unnoticed(read);
}

TEST_F(BreakAnywhere, ASyncIsSimplyDoneAgain) {
  const auto here = open_sqlite_store(folder_.file("here.db"));
  bool cut = true;
  for (int messages = 0; cut; messages += 3) {
    fill();
    here->transact([&] {
      for (const ObjectSummary& object : here->list()) here->remove_object(object.name);
      here->add_view("mug", made_view(1, 300), surf);  // both have it
      here->add_view("pan", made_view(11), surf);
    });
    const auto store = by_relay();
    here->set_note("sync " + store->location(), "");
    relay_->cut_after(messages);
    EXPECT_THAT(error_of([&] { sync_objects(*here, *store); }),
                testing::AnyOf("", testing::StartsWith("io: database")));
    cut = relay_->end_cut();
    sync_objects(*here, *store);
    EXPECT_EQ(state(*here), state(*direct_));
    EXPECT_EQ(list_views(*here).size(), 5U);
  }
}

}  // namespace
}  // namespace posevote::postgres
