#include "posevote/store/sqlite/schema.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Transaction.h>

#include <array>
#include <string>

namespace posevote::sqlite {
namespace {

// A step, once released, is never edited: databases out there were made by it. Large columns stand
// last, so that listing does not read them.
constexpr std::array steps{
    // 1: objects and views
    R"sql(
CREATE TABLE meta (key TEXT PRIMARY KEY, value) WITHOUT ROWID;
INSERT INTO meta VALUES ('changes', 0);
CREATE TABLE object (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  next_number INTEGER NOT NULL DEFAULT 1);
CREATE TABLE view (
  id INTEGER PRIMARY KEY,
  object INTEGER NOT NULL REFERENCES object(id) ON DELETE CASCADE,
  number INTEGER NOT NULL,
  identity TEXT NOT NULL,
  hash TEXT NOT NULL,
  yaw_deg REAL,
  width INTEGER NOT NULL,
  height INTEGER NOT NULL,
  centre_x REAL NOT NULL,
  centre_y REAL NOT NULL,
  coverage REAL NOT NULL,
  features INTEGER NOT NULL,
  dimension INTEGER NOT NULL,
  method TEXT NOT NULL,
  source TEXT NOT NULL,
  taught_at TEXT NOT NULL,
  version TEXT NOT NULL,
  outline BLOB NOT NULL,
  keypoints BLOB NOT NULL,
  descriptors BLOB NOT NULL,
  mask BLOB NOT NULL,
  picture BLOB NOT NULL,
  UNIQUE (object, number),
  UNIQUE (object, identity));
)sql",
    // 2: the pool of impostors
    R"sql(
CREATE TABLE impostor (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  identity TEXT NOT NULL UNIQUE,
  features INTEGER NOT NULL,
  dimension INTEGER NOT NULL,
  source TEXT NOT NULL,
  taught_at TEXT NOT NULL,
  version TEXT NOT NULL,
  keypoints BLOB NOT NULL,
  descriptors BLOB NOT NULL,
  picture BLOB NOT NULL);
)sql",
    // 3: what is made of the objects and can be made again
    R"sql(
CREATE TABLE derived (key TEXT PRIMARY KEY, version INTEGER NOT NULL, bytes BLOB NOT NULL);
)sql",
    // 4: views in small; views of older databases have none, it is made when they are loaded
    R"sql(
CREATE TABLE patch (
  view INTEGER PRIMARY KEY REFERENCES view(id) ON DELETE CASCADE,
  bytes BLOB NOT NULL);
)sql",
};

}  // namespace

const int newest_schema = static_cast<int>(steps.size());

void migrate(SQLite::Database& database, int version) {
  const auto present = [&] { return database.execAndGet("PRAGMA user_version").getInt(); };
  if (present() >= version) return;
  SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
  for (int step = present(); step < version; ++step)
    database.exec(steps[static_cast<std::size_t>(step)]);
  if (present() < version) {
    database.exec("PRAGMA application_id = " + std::to_string(application_id));
    database.exec("PRAGMA user_version = " + std::to_string(version));
  }
  transaction.commit();
}

}  // namespace posevote::sqlite
