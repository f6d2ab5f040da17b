#include "posevote/store/sqlite/schema.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <gmock/gmock.h>

#include "posevote/store/made_views.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"

namespace posevote::sqlite {
namespace {

const FeatureRecord surf{"surf64 1", "kind=surf\n"};

SQLite::Database create(const std::string& path) {
  return {path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE};
}

/// The statements that made all tables, as SQLite keeps them.
std::string tables(SQLite::Database& database) {
  std::string text;
  SQLite::Statement row(database, "SELECT sql FROM sqlite_schema ORDER BY name");
  while (row.executeStep()) text += row.getColumn(0).getString() + ";\n";
  return text;
}

TEST(Schema, EveryOlderOneBecomesTheNewest) {
  const ScratchFolder folder;
  auto fresh = create(folder.file("fresh.db"));
  migrate(fresh);
  for (int version = 1; version < newest_schema; ++version) {
    auto old = create(folder.file("old" + std::to_string(version)));
    migrate(old, version);
    EXPECT_EQ(old.execAndGet("PRAGMA user_version").getInt(), version);
    EXPECT_NE(tables(old), tables(fresh));
    migrate(old);
    EXPECT_EQ(tables(old), tables(fresh));
    EXPECT_EQ(old.execAndGet("PRAGMA user_version").getInt(), newest_schema);
    EXPECT_EQ(old.execAndGet("PRAGMA application_id").getInt(), application_id);
  }
}

TEST(Schema, MigratingTwiceChangesNothing) {
  const ScratchFolder folder;
  auto database = create(folder.file("x.db"));
  migrate(database);
  const std::string before = tables(database);
  migrate(database);
  migrate(database, 1);
  EXPECT_EQ(tables(database), before);
  EXPECT_EQ(database.execAndGet("PRAGMA user_version").getInt(), newest_schema);
}

TEST(Schema, ObjectsOfTheFirstSchemaAreStillThere) {
  const ScratchFolder folder;
  const std::string path = folder.file("old.db");
  {
    // A database of schema 1 with a view in it: the view's row comes from a store of today.
    const std::string today = folder.file("today.db");
    open_sqlite_store(today)->add_view("mug", made_view(1), surf);
    auto old = create(path);
    migrate(old, 1);
    old.exec("ATTACH '" + today + "' AS today");
    for (const char* table : {"object", "view"})
      old.exec(std::string("INSERT INTO main.") + table + " SELECT * FROM today." + table);
    old.exec("INSERT OR REPLACE INTO main.meta SELECT * FROM today.meta");
  }
  const auto store = open_sqlite_store(path);
  ASSERT_EQ(store->load()->views().size(), 1U);
  EXPECT_FALSE(store->load()->views()[0].view->patch.empty());  // made, as none was kept then
  EXPECT_EQ(store->add_view("mug", made_view(2), surf).id, "2");
  store->add_impostor({"", made_features(3), {1}, {}}, surf);
  EXPECT_EQ(store->impostors().size(), 1U);
}

}  // namespace
}  // namespace posevote::sqlite
