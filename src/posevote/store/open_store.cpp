#include "posevote/store/open_store.hpp"

#include "posevote/core/error.hpp"
#include "posevote/store/address.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"
#ifdef POSEVOTE_WITH_POSTGRES
#include "posevote/store/postgres/postgres_store.hpp"
#endif

namespace posevote {

bool is_server_address(const std::string& location) {
  return location.starts_with("postgresql://") || location.starts_with("postgres://");
}

std::unique_ptr<ObjectStore> open_store(const std::string& location, Access access) {
  if (is_server_address(location)) {
#ifdef POSEVOTE_WITH_POSTGRES
    PostgresOptions options;
    options.access = access;
    return open_postgres_store(location, options);
#else
    throw Error(ErrorCode::unsupported, "this build cannot use PostgreSQL, which '" +
                                            without_passwords(location) +
                                            "' needs; name a file instead");
#endif
  }
  SqliteOptions options;
  options.access = access;
  return open_sqlite_store(location, options);
}

}  // namespace posevote
