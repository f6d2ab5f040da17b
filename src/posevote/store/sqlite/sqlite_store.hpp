// The object store in one SQLite file.
#pragma once

#include <memory>
#include <string>

#include "posevote/store/object_store.hpp"

namespace posevote {

struct SqliteOptions {
  Access access = Access::create;
  int busy_timeout_ms = 10000;  ///< how long to wait for other writers
  bool check_integrity = true;  ///< look through the whole file for damage
  bool write_ahead = true;      ///< readers and a writer at once; false: the file stands alone
};

/// Opens or makes the database in file `path`. Throws Error{database_unusable} - and leaves the
/// file as it is - when it is damaged, not a posevote database or of a newer version;
/// Error{not_found} when it is not there and is not to be made; Error{io} when it cannot be opened.
[[nodiscard]] std::unique_ptr<ObjectStore> open_sqlite_store(const std::string& path,
                                                             const SqliteOptions& options = {});

}  // namespace posevote
