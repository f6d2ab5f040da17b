// The object store in a PostgreSQL database that many machines share.
#pragma once

#include <memory>
#include <string>

#include "posevote/store/object_store.hpp"

namespace posevote {

struct PostgresOptions {
  Access access = Access::create;
  int connect_timeout_s = 10;   ///< unless the address names another
  int busy_timeout_ms = 10000;  ///< how long to wait for other writers
};

/// Opens the schema `posevote` in the database that `address` (postgresql://USER@HOST:PORT/NAME)
/// names, makes it with Access::create when it is not there, and brings an older one to the newest
/// version when the user owns it. A password is best left out of the address: libpq reads it from
/// ~/.pgpass or $PGPASSFILE; it never appears in messages or `location()`.
///
/// A lost connection is made again: a reading call tries twice; a change that was under way fails
/// with Error{io} and leaves nothing behind. Writers wait for each other. Errors as
/// `open_sqlite_store`; Error{io} also when the server does not answer or the user has no right to
/// do it (see roles.sql for the rights that there are).
[[nodiscard]] std::unique_ptr<ObjectStore> open_postgres_store(const std::string& address,
                                                               const PostgresOptions& options = {});

}  // namespace posevote
