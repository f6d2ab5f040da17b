#include "posevote/store/sqlite/connection.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <sqlite3.h>

#include <filesystem>

#include "posevote/store/sqlite/schema.hpp"
#include "posevote/store/stored_view.hpp"

namespace posevote::sqlite {
namespace {

namespace fs = std::filesystem;

bool holds_data(const std::string& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  return !error && size > 0;
}

void check_place(const std::string& path, const SqliteOptions& options) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::directory)
    throw_database_error(ErrorCode::io, path, "is a folder");
  if (fs::exists(status) && status.type() != fs::file_type::regular)
    throw_database_error(ErrorCode::io, path, "is not a regular file");
  if (status.type() == fs::file_type::none)
    throw_database_error(ErrorCode::io, path, "cannot be opened: " + error.message());
  if (options.access != Access::create && !holds_data(path))
    throw_database_error(ErrorCode::not_found, path,
                         "does not exist; teach an object first: posevote teach --help");
  const fs::path folder = fs::absolute(path).parent_path();
  if (!fs::exists(status) && !fs::is_directory(folder, error))
    throw_database_error(ErrorCode::io, path,
                         "cannot be made: there is no folder '" + folder.string() + "'");
}

/// A file in a folder that may not be written, made with write-ahead logging, opens only as
/// immutable.
SQLite::Database open_unwritable(const std::string& path) {
  std::string uri = "file:";
  for (const char c : fs::absolute(path).string()) {
    if (c == '?' || c == '#' || c == '%') {
      constexpr const char* digits = "0123456789abcdef";
      const auto byte = static_cast<unsigned char>(c);
      uri += {'%', digits[byte >> 4], digits[byte & 15]};
    } else {
      uri += c;
    }
  }
  return {uri + "?immutable=1", SQLite::OPEN_READONLY | SQLite::OPEN_URI};
}

SQLite::Database open_file(const std::string& path, const SqliteOptions& options) {
  const std::string place = fs::absolute(path).string();  // no special names such as ":memory:"
  int flags = SQLite::OPEN_READWRITE;
  if (options.access == Access::create) flags |= SQLite::OPEN_CREATE;
  if (options.access == Access::read_only) flags = SQLite::OPEN_READONLY;
  try {
    SQLite::Database database(place, flags, options.busy_timeout_ms);
    database.exec("SELECT count(*) FROM sqlite_schema");
    return database;
  } catch (const SQLite::Exception& error) {
    const bool unwritable =
        error.getErrorCode() == SQLITE_CANTOPEN || error.getErrorCode() == SQLITE_READONLY;
    if (!unwritable || !holds_data(path) || holds_data(path + "-wal")) throw;
    return open_unwritable(path);
  }
}

void configure(SQLite::Database& database) {
  database.exec("PRAGMA foreign_keys = ON");
  database.exec("PRAGMA trusted_schema = OFF");
  database.exec("PRAGMA cell_size_check = ON");
  database.exec("PRAGMA synchronous = FULL");
  sqlite3_db_config(database.getHandle(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
}

void check_integrity(SQLite::Database& database, const std::string& path) {
  const auto pages = database.execAndGet("PRAGMA page_count").getInt64();
  const auto page_bytes = database.execAndGet("PRAGMA page_size").getInt64();
  std::error_code error;
  const auto bytes = static_cast<std::int64_t>(fs::file_size(path, error));
  if (bytes < pages * page_bytes && !holds_data(path + "-wal"))  // newer pages may be in the log
    throw_database_error(ErrorCode::database_unusable, path,
                         "is damaged (cut off); restore a copy of it");
  const std::string verdict = database.execAndGet("PRAGMA quick_check(1)").getString();
  if (verdict != "ok")
    throw_database_error(
        ErrorCode::database_unusable, path,
        "is damaged (" + verdict.substr(0, verdict.find('\n')) + "); restore a copy of it");
}

/// Everything that can be said against an existing file, before anything is written to it.
void check_content(SQLite::Database& database, const std::string& path,
                   const SqliteOptions& options) {
  if (database.execAndGet("PRAGMA application_id").getInt() != application_id)
    throw_database_error(ErrorCode::database_unusable, path,
                         "is a SQLite database, but not one of posevote");
  const int version = database.execAndGet("PRAGMA user_version").getInt();
  if (version > newest_schema)
    throw_database_error(ErrorCode::database_unusable, path,
                         "was made by a newer version of posevote (schema " +
                             std::to_string(version) + ", this one knows " +
                             std::to_string(newest_schema) + "); update posevote");
  if (options.check_integrity) check_integrity(database, path);
}

void set_journal(SQLite::Database& database, bool write_ahead) {
  const std::string wanted = write_ahead ? "wal" : "delete";
  if (database.execAndGet("PRAGMA journal_mode").getString() == wanted) return;
  try {
    database.execAndGet("PRAGMA journal_mode = " + wanted);
  } catch (const SQLite::Exception& error) {
    // Somebody else is reading: stays as it is, which is safe too, until it is opened next time.
    if (error.getErrorCode() != SQLITE_BUSY) throw;
  }
}

/// Keeps SQLite from writing a left-over log into the database while this is not yet accepted.
void write_log_at_close(SQLite::Database& database, bool on) {
  sqlite3_db_config(database.getHandle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, on ? 0 : 1, nullptr);
}

}  // namespace

void rethrow(const SQLite::Exception& error, const std::string& path) {
  switch (error.getErrorCode()) {
    case SQLITE_NOTADB:
      throw_database_error(ErrorCode::database_unusable, path, "is not a database");
    case SQLITE_CORRUPT:
    case SQLITE_FORMAT:
      throw_database_error(ErrorCode::database_unusable, path, "is damaged; restore a copy of it");
    case SQLITE_FULL:
      throw_database_error(ErrorCode::io, path,
                           "cannot be written: the disk is full; nothing was changed");
    case SQLITE_IOERR:
      throw_database_error(
          ErrorCode::io, path,
          "cannot be read or written (is the disk full or faulty?); nothing was changed");
    case SQLITE_READONLY:
      throw_database_error(ErrorCode::io, path, "cannot be written: it is read-only");
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
      throw_database_error(ErrorCode::io, path, "cannot be opened; may its folder be written?");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw_database_error(ErrorCode::io, path, "is in use by another program; try again");
    case SQLITE_NOMEM:
      throw std::bad_alloc();
    case SQLITE_TOOBIG:
      throw_database_error(ErrorCode::invalid_argument, path, "cannot take a picture that large");
    default:
      throw_database_error(ErrorCode::database_unusable, path,
                           std::string("cannot be used: ") + error.what());
  }
}

SQLite::Database connect(const std::string& path, const SqliteOptions& options) {
  check_place(path, options);
  return guarded(path, [&] {
    const bool existed = holds_data(path);
    const bool had_log = holds_data(path + "-wal");
    SQLite::Database database = open_file(path, options);
    if (had_log) write_log_at_close(database, false);
    configure(database);
    if (existed) check_content(database, path, options);
    write_log_at_close(database, true);
    const bool writable = sqlite3_db_readonly(database.getHandle(), "main") == 0;
    if (writable) {
      migrate(database);
      set_journal(database, options.write_ahead);
    } else if (database.execAndGet("PRAGMA user_version").getInt() < newest_schema) {
      throw_database_error(
          ErrorCode::database_unusable, path,
          "is of an older version of posevote; open it once with permission to write");
    }
    return database;
  });
}

}  // namespace posevote::sqlite
