#include "posevote/store/open_store.hpp"

#include "posevote/core/error.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"

namespace posevote {

bool is_server_address(const std::string& location) {
  return location.starts_with("postgresql://") || location.starts_with("postgres://");
}

std::unique_ptr<ObjectStore> open_store(const std::string& location, Access access) {
  if (is_server_address(location))
    throw Error(ErrorCode::unsupported, "this build cannot use PostgreSQL; name a file instead");
  SqliteOptions options;
  options.access = access;
  return open_sqlite_store(location, options);
}

}  // namespace posevote
