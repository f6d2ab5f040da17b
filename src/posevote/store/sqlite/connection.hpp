// A checked connection to a SQLite file, and SQLite's errors as ours.
#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>

#include <string>

#include "posevote/store/sqlite/sqlite_store.hpp"

namespace posevote::sqlite {

/// Throws the posevote::Error that `error` amounts to, with the database's path.
[[noreturn]] void rethrow(const SQLite::Exception& error, const std::string& path);

/// Runs `work`, turning SQLite's exceptions into posevote::Error.
template <class Work>
auto guarded(const std::string& path, Work work) {
  try {
    return work();
  } catch (const SQLite::Exception& error) {
    rethrow(error, path);
  }
}

/// Opens `path` as `open_sqlite_store` promises: what exists is checked before anything is written,
/// and brought to the newest schema; what does not exist is made.
[[nodiscard]] SQLite::Database connect(const std::string& path, const SqliteOptions& options);

}  // namespace posevote::sqlite
