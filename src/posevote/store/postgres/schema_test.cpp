#include "posevote/store/postgres/schema.hpp"

#include <gmock/gmock.h>

#include "posevote/store/postgres/postgres_store.hpp"
#include "posevote/store/postgres/relay.hpp"
#include "posevote/store/postgres/test_server.hpp"
#include "posevote/store/sync.hpp"

namespace posevote::postgres {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const FeatureRecord surf{"surf64 1", "kind=surf\n"};

class PostgresSchema : public ServerTest {
 protected:
  void bring_to(int version) const {
    pqxx::connection connection(server_.address(database_));
    pqxx::work work(connection);
    migrate(work, version);
    work.commit();
  }
  int present() const {
    pqxx::connection connection(server_.address(database_));
    pqxx::work work(connection);
    return present_schema(work);
  }
  /// Takes away what later steps have brought.
  void go_back_to(int version) const {
    const std::array undo{"DROP TABLE posevote.impostor", "DROP TABLE posevote.derived",
                          "ALTER TABLE posevote.view DROP COLUMN patch"};
    for (int step = newest_schema; step > version; --step)
      server_.run(database_, undo.at(static_cast<std::size_t>(step) - 2));
    server_.run(database_, "UPDATE posevote.meta SET value = " + std::to_string(version) +
                               " WHERE key = 'schema'");
  }
  std::unique_ptr<ObjectStore> open() const {
    return open_postgres_store(server_.address(database_));
  }
  /// Something of everything that a database can hold.
  void fill() const {
    const auto store = open();
    for (int i = 0; i < 3; ++i) store->add_view("mug", made_view(i, 50), surf);
    store->add_view("cup", made_view(3), surf);
    store->add_impostor({"", made_features(3), {1}, {}}, surf);
    store->set_note("a", "b");
    store->set_derived("index", {store->version(), "bytes"});
  }
  /// All that `fill` made and schema `version` can hold, as text.
  std::string contents(int version) const {
    const auto store = open();
    std::string text = "note " + store->note("a") + "\n";
    if (version >= 3) text += "derived " + store->derived("index").bytes + "\n";
    for (const KnownView& view : list_views(*store))
      if (version >= 2 || !view.key.object.empty())
        text += view.key.object + " " + view.key.identity + " " + view.hash + "\n";
    const auto models = store->load();
    for (const auto& entry : models->views())
      text += std::to_string(entry.view->features.size()) + " features, patch " +
              std::to_string(cv::sum(entry.view->patch.pixels)[0]) + "\n";
    return text;
  }
  /// All columns, constraints, indexes and triggers of the schema.
  std::string tables() const {
    std::string text;
    for (const pqxx::row row : server_.run(database_, R"sql(
      SELECT table_name || '.' || column_name || ' ' || data_type || ' ' || is_nullable
        FROM information_schema.columns WHERE table_schema = 'posevote'
      UNION ALL SELECT conrelid::regclass::text || ' ' || pg_get_constraintdef(oid)
        FROM pg_constraint WHERE connamespace = 'posevote'::regnamespace
      UNION ALL SELECT pg_get_triggerdef(oid) FROM pg_trigger
        WHERE NOT tgisinternal AND tgrelid::regclass::text LIKE 'posevote.%'
      ORDER BY 1)sql"))
      text += std::string(row[0].c_str()) + "\n";
    return text;
  }
};

TEST_F(PostgresSchema, EveryOlderOneBecomesTheNewest) {
  bring_to(newest_schema);
  const std::string newest = tables();
  for (int version = 1; version < newest_schema; ++version) {
    server_.run(database_, "DROP SCHEMA posevote CASCADE");
    EXPECT_EQ(present(), 0);
    bring_to(version);
    EXPECT_EQ(present(), version);
    EXPECT_NE(tables(), newest);
    bring_to(newest_schema);
    EXPECT_EQ(tables(), newest);
  }
  bring_to(1);
  EXPECT_EQ(present(), newest_schema);
}

TEST_F(PostgresSchema, WhatOlderOnesHoldIsStillThere) {
  for (int version = 1; version < newest_schema; ++version) {
    fill();
    const std::string before = contents(version);
    go_back_to(version);
    EXPECT_EQ(contents(version), before) << version;  // patches are made, as none were kept then
    EXPECT_EQ(present(), newest_schema);
    open()->add_impostor({"", made_features(4), {2}, {}}, surf);
    EXPECT_EQ(open()->impostors().size(), version >= 2 ? 2U : 1U);
    server_.run(database_, "DROP SCHEMA posevote CASCADE");
  }
}

TEST_F(PostgresSchema, CutShortAMigrationIsDoneTheNextTime) {
  Relay relay(server_.socket_path());
  fill();
  const std::string expected = contents(1);
  for (int version = 0; version < newest_schema; ++version) {
    bool cut = true;
    int cuts = 0;
    for (int messages = 0; cut; ++messages) {
      if (version == 0)
        server_.run(database_, "DROP SCHEMA IF EXISTS posevote CASCADE");
      else
        go_back_to(version);
      relay.cut_after(messages);
      const std::string error =
          error_of([&] { static_cast<void>(open_postgres_store(relay.address(database_))); });
      cut = relay.end_cut();
      cuts += cut;
      EXPECT_THAT(error, testing::AnyOf("", StartsWith("io: database")));
      EXPECT_THAT(error, Not(HasSubstr("\n")));
      EXPECT_THAT(present(), testing::AnyOf(version, newest_schema));
      if (version > 0) {
        EXPECT_EQ(contents(1), expected);
      }
      static_cast<void>(open());
      EXPECT_EQ(present(), newest_schema);
    }
    EXPECT_GT(cuts, 3);
    if (version == 0) fill();
  }
}

TEST_F(PostgresSchema, AServerThatSaysNothingIsGivenUp) {
  Relay relay(server_.socket_path());
  relay.set_frozen(true);
  PostgresOptions options;
  options.connect_timeout_s = 2;
  const std::string error =
      error_of([&] { static_cast<void>(open_postgres_store(relay.address(database_), options)); });
  EXPECT_THAT(error, testing::AllOf(StartsWith("io: database"), HasSubstr("cannot be reached"),
                                    Not(HasSubstr("\n"))));
  relay.set_frozen(false);
  EXPECT_EQ(present(), 0);
}

TEST_F(PostgresSchema, WhatIsNotThereIsMadeOnlyWhenAskedTo) {
  PostgresOptions options;
  for (const Access access : {Access::existing, Access::read_only}) {
    options.access = access;
    EXPECT_THAT(error_of([&] {
                  static_cast<void>(open_postgres_store(server_.address(database_), options));
                }),
                StartsWith("not_found"));
  }
  EXPECT_EQ(present(), 0);
}

TEST_F(PostgresSchema, ANewerOneIsRefused) {
  bring_to(newest_schema);
  server_.run(database_, "UPDATE posevote.meta SET value = value + 1 WHERE key = 'schema'");
  EXPECT_THAT(error_of([&] { static_cast<void>(open_postgres_store(server_.address(database_))); }),
              testing::AllOf(StartsWith("database_unusable"), HasSubstr("newer version")));
}

TEST_F(PostgresSchema, ChangesByHandAreCountedAndToldToo) {
  const auto store = open_postgres_store(server_.address(database_));
  store->add_view("mug", made_view(1), surf);
  const std::int64_t version = store->version();
  EXPECT_FALSE(store->wait_for_change(version, std::chrono::milliseconds(1)));
  server_.run(database_, "UPDATE posevote.object SET name = 'cup'");
  EXPECT_TRUE(store->wait_for_change(version, std::chrono::minutes(1)));
  EXPECT_GT(store->version(), version);
}

/// Logins with each of the roles that roles.sql makes. Roles belong to the whole server, so that
/// these tests come one after the other.
class PostgresRoles : public PostgresSchema {
 protected:
  void SetUp() override {
    PostgresSchema::SetUp();
    if (IsSkipped()) return;
    lock_ = std::make_unique<pqxx::connection>(server_.address("postgres"));
    pqxx::nontransaction(*lock_).exec("SELECT pg_advisory_lock(1)");
    if (server_.run("postgres", "SELECT 1 FROM pg_roles WHERE rolname = 'test_owner'").empty())
      server_.run("postgres", "CREATE ROLE test_owner LOGIN");
    server_.run("postgres", "GRANT CREATE ON DATABASE \"" + database_ + "\" TO test_owner");
    store_ = as("owner");
    store_->add_view("mug", made_view(1), surf);
    std::ifstream file(POSEVOTE_SOURCE_DIR "/src/posevote/store/postgres/roles.sql");
    const std::string sql{std::istreambuf_iterator<char>(file), {}};
    server_.run(database_, sql);  // by somebody who is not the owner
    server_.run(database_, sql);  // may be run again
    for (const char* role : {"reader", "teacher", "administrator"}) create_user(role);
  }
  void create_user(const std::string& role) const {
    server_.run("postgres", "DROP ROLE IF EXISTS test_" + role);
    server_.run("postgres", "CREATE ROLE test_" + role + " LOGIN IN ROLE posevote_" + role);
  }
  std::unique_ptr<ObjectStore> as(const std::string& role) const {
    return open_postgres_store(server_.address(database_, "test_" + role));
  }

  std::unique_ptr<pqxx::connection> lock_;
  std::unique_ptr<ObjectStore> store_;
};

TEST_F(PostgresRoles, AReaderReadsAndIsToldOfChanges) {
  const auto reader = as("reader");
  EXPECT_TRUE(reader->read_only());
  EXPECT_EQ(reader->load()->views().size(), 1U);
  EXPECT_EQ(reader->view("mug", "1").view.id, "1");
  const std::int64_t version = reader->version();
  store_->add_view("mug", made_view(2), surf);
  EXPECT_TRUE(reader->wait_for_change(version, std::chrono::minutes(1)));
  for (const std::function<void()>& change : std::initializer_list<std::function<void()>>{
           [&] { reader->add_view("mug", made_view(3), surf); },
           [&] { reader->remove_object("mug"); }, [&] { reader->rename_object("mug", "cup"); }})
    EXPECT_THAT(error_of(change), testing::AllOf(StartsWith("io"), HasSubstr("the right")));
  EXPECT_EQ(reader->views("mug").size(), 2U);
}

TEST_F(PostgresRoles, ATeacherAddsAndRemovesNothing) {
  const auto teacher = as("teacher");
  EXPECT_FALSE(teacher->read_only());
  EXPECT_FALSE(teacher->may_remove());
  teacher->add_view("mug", made_view(2), surf);
  teacher->add_view("cup", made_view(3), surf);
  teacher->add_impostor({"", made_features(3), {1}, {}}, surf);
  EXPECT_EQ(store_->list().size(), 2U);
  for (const std::function<void()>& change : std::initializer_list<std::function<void()>>{
           [&] { teacher->remove_view("mug", "1"); }, [&] { teacher->remove_object("cup"); },
           [&] { teacher->rename_object("cup", "pot"); }, [&] { teacher->remove_impostor("1"); }})
    EXPECT_THAT(error_of(change), testing::AllOf(StartsWith("io"), HasSubstr("the right")));
  EXPECT_EQ(store_->list().size(), 2U);
}

TEST_F(PostgresRoles, AnAdministratorDoesEverythingWithObjects) {
  const auto administrator = as("administrator");
  EXPECT_TRUE(administrator->may_remove());
  administrator->add_view("cup", made_view(3), surf);
  administrator->rename_object("cup", "pot");
  administrator->rebuild(surf, [](const auto&, const auto&) { return made_features(4); });
  administrator->remove_view("mug", "1");
  administrator->remove_object("pot");
  EXPECT_TRUE(store_->list().empty());
}

TEST_F(PostgresRoles, OnlyTheOwnerMigrates) {
  go_back_to(1);
  for (const char* role : {"reader", "teacher", "administrator"})
    EXPECT_THAT(error_of([&] { static_cast<void>(as(role)); }),
                testing::AllOf(StartsWith("database_unusable"), HasSubstr("owner")));
  EXPECT_EQ(present(), 1);
  static_cast<void>(as("owner"));
  as("teacher")->add_view("mug", made_view(2), surf);
  EXPECT_EQ(as("reader")->load()->views().size(), 2U);
  EXPECT_TRUE(as("reader")->impostors().empty());  // new tables, too, may be read
}

TEST_F(PostgresRoles, AStrangerSeesNothing) {
  server_.run("postgres", "DROP ROLE IF EXISTS test_stranger");
  server_.run("postgres", "CREATE ROLE test_stranger LOGIN");
  EXPECT_THAT(error_of([&] { static_cast<void>(as("stranger")); }), StartsWith("io"));
}

}  // namespace
}  // namespace posevote::postgres
