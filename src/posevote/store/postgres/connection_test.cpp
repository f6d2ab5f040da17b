// Servers that do not answer, passwords, and connections that break in the middle of everything.
#include "posevote/store/postgres/connection.hpp"

#include <gmock/gmock.h>

#include <condition_variable>

#include "posevote/store/follower.hpp"
#include "posevote/store/postgres/test_server.hpp"

namespace posevote::postgres {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const FeatureRecord surf{"surf64 1", "kind=surf\n"};

class PostgresConnection : public ServerTest {
 protected:
  std::unique_ptr<ObjectStore> open() const {
    return open_postgres_store(server_.address(database_));
  }
};

TEST(PostgresAddress, TimeLimitsAreAddedUnlessTheyAreGiven) {
  EXPECT_THAT(complete_address("postgresql://h/d", {}), StartsWith("postgresql://h/d?connect_"));
  const std::string own = complete_address("postgresql://h/d?connect_timeout=3", {});
  EXPECT_THAT(own, StartsWith("postgresql://h/d?connect_timeout=3&"));
  EXPECT_THAT(own, Not(HasSubstr("connect_timeout=10")));
  EXPECT_THAT(complete_address("postgresql://a:b?c@h/d", {}), HasSubstr("@h/d?connect_"));
  EXPECT_THAT(complete_address("postgresql://h?host=/tmp", {}), HasSubstr("/tmp&connect_"));
}

TEST(PostgresAddress, AServerThatIsNotThereIsSaidWithoutThePassword) {
  for (const char* address :
       {"postgresql://robot:secret@127.0.0.1:1/db",
        "postgresql://robot@127.0.0.1:1/db?password=secret",
        "postgresql://robot:secret@/db?host=/nowhere", "postgresql://robot:secret@127.0.0.1:x/db",
        "postgresql://robot:secret@127.0.0.1/db?nonsense=1",
        "postgresql://robot:secret%@127.0.0.1/db", "postgresql://robot:100%secret@127.0.0.1/db",
        "postgresql://127.0.0.1/db?password=100%secret", "postgresql://robot:secret%00@h/db",
        "postgresql://robot:p@secret@nowhere/db", "postgresql://robot:secret/p@127.0.0.1/db",
        "postgresql://robot:secret?'\" @127.0.0.1:1/db"})
    EXPECT_THAT(error_of([&] { static_cast<void>(open_postgres_store(address)); }),
                AllOf(StartsWith("io"), HasSubstr("***"), Not(HasSubstr("secret"))));
}

TEST_F(PostgresConnection, APasswordIsNeverSaid) {
  const std::string user = "user_" + std::to_string(getpid());
  server_.run("postgres", "CREATE ROLE " + user + " LOGIN SUPERUSER PASSWORD 'secret'");
  const auto store = open_postgres_store(server_.loopback(database_, user + ":secret"));
  EXPECT_THAT(store->location(),
              AllOf(HasSubstr(user + ":***@127.0.0.1"), Not(HasSubstr("secret"))));
  EXPECT_THAT(error_of([&] { store->remove_object("mug"); }),
              AllOf(StartsWith("not_found"), Not(HasSubstr("secret"))));
  EXPECT_THAT(
      error_of([&] {
        static_cast<void>(open_postgres_store(server_.loopback(database_, user + ":wrong")));
      }),
      AllOf(StartsWith("io"), HasSubstr("password"), Not(HasSubstr("wrong"))));
}

TEST_F(PostgresConnection, APasswordMayHoldAnything) {
  const std::pair<const char*, const char*> cases[]{{"se?cret", "se?cret"},
                                                    {"se''cret", "se'cret"},
                                                    {"se\"cret", "se\"cret"},
                                                    {"se cret", "se cret"},
                                                    {"se%cret", "se%25cret"}};
  int number = 0;
  for (const auto& [in_sql, written] : cases) {
    const std::string user = "any_" + std::to_string(getpid()) + "_" + std::to_string(number++);
    server_.run("postgres",
                "CREATE ROLE " + user + " LOGIN SUPERUSER PASSWORD '" + std::string(in_sql) + "'");
    const std::string login = user + ":" + written;
    const auto store = open_postgres_store(server_.loopback(database_, login));
    EXPECT_THAT(store->location(), AllOf(HasSubstr(user + ":***@"), Not(HasSubstr("cret"))));
    const auto error =
        error_of([&] { static_cast<void>(open_postgres_store(server_.loopback("none", login))); });
    EXPECT_THAT(error, AllOf(StartsWith("io"), HasSubstr("none"), Not(HasSubstr("cret"))));
  }
}

TEST_F(PostgresConnection, ReadingGoesOnAfterABreak) {
  const auto store = open();
  store->add_view("mug", made_view(1), surf);
  server_.break_connections(database_);
  EXPECT_EQ(store->list().size(), 1U);
  server_.break_connections(database_);
  EXPECT_EQ(store->load()->views().size(), 1U);
  server_.break_connections(database_);
  EXPECT_EQ(store->add_view("mug", made_view(2), surf).id, "2");
}

TEST_F(PostgresConnection, ABreakInTheMiddleOfAChangeLeavesNothing) {
  const auto store = open();
  EXPECT_THAT(error_of([&] {
                store->transact([&] {
                  store->add_view("mug", made_view(1), surf);
                  server_.break_connections(database_);
                  store->add_view("mug", made_view(2), surf);
                });
              }),
              AllOf(StartsWith("io"), HasSubstr(database_)));
  EXPECT_TRUE(store->list().empty());
  int calls = 0;
  store->add_view("mug", made_view(1), surf);
  EXPECT_THAT(error_of([&] {
                store->rebuild(surf, [&](const auto&, const auto&) {
                  if (++calls == 1) server_.break_connections(database_);
                  return made_features(7);
                });
              }),
              StartsWith("io"));
  EXPECT_EQ(store->view("mug", "1").view.features.size(), made_view(1).view.features.size());
}

TEST_F(PostgresConnection, AFollowerOutlivesBreaks) {
  const std::shared_ptr<ObjectStore> here = open();
  const auto there = open();
  std::mutex mutex;
  std::condition_variable arrived;
  std::size_t views = 0;
  const auto wait_for = [&](std::size_t wanted) {
    std::unique_lock lock(mutex);
    arrived.wait(lock, [&] { return views == wanted; });
  };
  const Follower follower(here, here->version(), [&](const auto& models) {
    const std::lock_guard lock(mutex);
    views = models->views().size();
    arrived.notify_all();
  });
  there->add_view("mug", made_view(1), surf);
  wait_for(1);
  for (std::size_t i = 2; i < 5; ++i) {
    server_.break_connections(database_);
    there->add_view("mug", made_view(static_cast<int>(i)), surf);
    wait_for(i);
  }
}

TEST_F(PostgresConnection, AWriterThatIsBusyForTooLongIsSaid) {
  PostgresOptions impatient;
  impatient.busy_timeout_ms = 50;
  const auto store = open(), other = open_postgres_store(server_.address(database_), impatient);
  store->transact([&] {
    store->add_view("mug", made_view(1), surf);
    EXPECT_THAT(error_of([&] { other->add_view("mug", made_view(2), surf); }),
                AllOf(StartsWith("io"), HasSubstr("in use")));
    EXPECT_TRUE(other->list().empty());
  });
  EXPECT_EQ(other->add_view("mug", made_view(2), surf).id, "2");
}

TEST_F(PostgresConnection, DamageIsNoticed) {
  const auto store = open();
  store->add_view("mug", made_view(1), surf);
  server_.run(database_, "UPDATE posevote.view SET descriptors = set_byte(descriptors, 5, 77)");
  EXPECT_THAT(error_of([&] { static_cast<void>(store->load()); }), StartsWith("database_unusable"));
  server_.run(database_, "UPDATE posevote.view SET keypoints = '\\x00'");
  EXPECT_THAT(error_of([&] { static_cast<void>(store->load()); }),
              AllOf(StartsWith("database_unusable"), HasSubstr("damaged")));
}

TEST_F(PostgresConnection, APatchIsReadAndNotMadeAgain) {
  const auto store = open();
  store->add_view("mug", made_view(1), surf);
  server_.run(database_, "UPDATE posevote.view SET picture = '\\x00'");
  EXPECT_FALSE(store->load()->views()[0].view->patch.empty());
  server_.run(database_, "UPDATE posevote.view SET patch = '\\x00'");
  EXPECT_THAT(error_of([&] { static_cast<void>(open()->load()); }),
              AllOf(StartsWith("database_unusable"), HasSubstr(database_)));
}

TEST_F(PostgresConnection, OpenedForReadingItIsNotChanged) {
  open()->add_view("mug", made_view(1), surf);
  PostgresOptions options;
  options.access = Access::read_only;
  const auto store = open_postgres_store(server_.address(database_), options);
  EXPECT_TRUE(store->read_only());
  EXPECT_THAT(error_of([&] { store->remove_object("mug"); }), StartsWith("io"));
  EXPECT_EQ(store->list().size(), 1U);
}

}  // namespace
}  // namespace posevote::postgres
