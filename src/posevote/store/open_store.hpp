// A database by its name alone.
#pragma once

#include <memory>
#include <string>

#include "posevote/store/object_store.hpp"

namespace posevote {

/// Whether `location` is the address of a server: postgresql://... or postgres://...
[[nodiscard]] bool is_server_address(const std::string& location);

/// Opens what `location` names: a SQLite file, or a database on a server. Throws what
/// `open_sqlite_store` and `open_postgres_store` throw, Error{unsupported} for an address when the
/// library was built without PostgreSQL.
[[nodiscard]] std::unique_ptr<ObjectStore> open_store(const std::string& location,
                                                      Access access = Access::create);

}  // namespace posevote
