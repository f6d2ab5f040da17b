// How soon, and at what cost, a change made elsewhere is known.
#include <gmock/gmock.h>

#include <condition_variable>

#include "posevote/core/stopwatch.hpp"
#include "posevote/store/follower.hpp"
#include "posevote/store/postgres/postgres_store.hpp"
#include "posevote/store/postgres/relay.hpp"
#include "posevote/store/postgres/test_server.hpp"

namespace posevote::postgres {
namespace {

const FeatureRecord surf{"surf64 1", "kind=surf\n"};

class Following : public ServerTest {
 protected:
  void SetUp() override {
    ServerTest::SetUp();
    if (IsSkipped()) return;
    relay_ = std::make_unique<Relay>(server_.socket_path());
    there_ = open_postgres_store(server_.address(database_));
  }
  void TearDown() override {
    relay_.reset();
    ServerTest::TearDown();
  }

  std::unique_ptr<Relay> relay_;
  std::unique_ptr<ObjectStore> there_;
};

/// Objects and their views, as text.
std::string contents(const ModelSet& models) {
  std::string text;
  for (const ModelSet::Entry& entry : models.views())
    text +=
        models.objects()[static_cast<std::size_t>(entry.object)].name + " " + entry.view->id + "; ";
  return text;
}

TEST_F(Following, TaughtChangedAndRemovedObjectsArrive) {
  const std::shared_ptr<ObjectStore> here = open_postgres_store(server_.address(database_));
  std::mutex mutex;
  std::condition_variable arrived;
  std::string known;
  const Follower follower(here, here->version(), [&](const auto& models) {
    const std::lock_guard lock(mutex);
    known = contents(*models);
    arrived.notify_all();
  });
  std::vector<double> times_ms;
  const auto expect = [&](const std::string& wanted, const std::function<void()>& change) {
    change();
    Stopwatch watch;
    std::unique_lock lock(mutex);
    arrived.wait(lock, [&] { return known == wanted; });
    times_ms.push_back(watch.lap());
  };
  for (int round = 0; round < 10; ++round) {
    expect("mug 1; ", [&] { there_->add_view("mug", made_view(2 * round), surf); });
    expect("mug 1; mug 2; ", [&] { there_->add_view("mug", made_view(2 * round + 1), surf); });
    expect("mug 2; ", [&] { there_->remove_view("mug", "1"); });
    expect("pot 2; ", [&] { there_->rename_object("mug", "pot"); });
    expect("", [&] { there_->remove_object("pot"); });
  }
  std::ranges::sort(times_ms);
  RecordProperty("median_ms", std::to_string(times_ms[times_ms.size() / 2]));
  RecordProperty("worst_ms", std::to_string(times_ms.back()));
}

TEST_F(Following, OnlyWhatChangedIsLoaded) {
  there_->transact([&] {
    for (int i = 0; i < 200; ++i)
      there_->add_view("object " + std::to_string(i % 20), made_view(i, 300), surf);
    for (int i = 0; i < 50; ++i)
      there_->add_impostor({"", made_features(1000 + i, 300), {std::uint8_t(i)}, {}}, surf);
  });
  const auto here = open_postgres_store(relay_->address(database_));
  const auto loaded = [&](std::shared_ptr<const ModelSet>& models) {
    const std::size_t before = relay_->received();
    models = here->load();
    return relay_->received() - before;
  };
  std::shared_ptr<const ModelSet> models;
  const std::size_t all = loaded(models);
  EXPECT_EQ(models->views().size(), 200U);
  const std::size_t nothing = loaded(models);
  EXPECT_LT(nothing, all / 100);
  there_->remove_view("object 7", "3");
  there_->add_view("object 7", made_view(300, 300), surf);
  const std::size_t a_view = loaded(models);
  EXPECT_LT(a_view, nothing + all / 100);
  there_->remove_impostor(there_->impostors()[4].id);
  there_->add_impostor({"", made_features(2000, 300), {200}, {}}, surf);
  const std::size_t an_impostor = loaded(models);
  EXPECT_LT(an_impostor, nothing + all / 100);
  EXPECT_EQ(models->impostors().size(), 50U);
  EXPECT_EQ(models->impostors().back().keypoints[0].x, made_features(2000, 300).keypoints[0].x);
  EXPECT_EQ(models->views().size(), 200U);
  for (const auto& [name, bytes] : {std::pair("all", all),
                                    {"nothing", nothing},
                                    {"one_view", a_view},
                                    {"one_impostor", an_impostor}})
    RecordProperty(std::string(name) + "_bytes", std::to_string(bytes));
}

TEST_F(Following, ImpostorsThatWereMadeAnewAreLoadedAnew) {
  there_->add_impostor({"", made_features(1), {1, 2, 3}, {}}, surf);
  const auto here = open_postgres_store(server_.address(database_));
  EXPECT_EQ(here->load()->impostors()[0].size(), 5U);
  for (const int count : {7, 8}) {
    there_->rebuild(surf, [&](const auto&, const auto&) { return made_features(1, count); });
    EXPECT_EQ(here->load()->impostors()[0].size(), static_cast<std::size_t>(count));
  }
}

}  // namespace
}  // namespace posevote::postgres
