// A connection to a PostgreSQL server, and its errors as ours.
#pragma once

#include <memory>
#include <pqxx/pqxx>
#include <string>

#include "posevote/store/postgres/postgres_store.hpp"

namespace posevote::postgres {

/// A connection that keeps the server's notices to itself.
struct Link {
  explicit Link(const std::string& address) : connection(address) {}
  virtual ~Link() = default;
  pqxx::connection connection;
  pqxx::quiet_errorhandler quiet{connection};
};

/// `address` with what the options say and with time limits for a network that is gone.
[[nodiscard]] std::string complete_address(const std::string& address,
                                           const PostgresOptions& options);

/// Throws the posevote::Error that the exception in flight amounts to; `location` names the
/// database, and the passwords of `address` are not told.
[[noreturn]] void rethrow(const std::string& location, const std::string& address);

/// Runs `work`, turning libpqxx's exceptions into posevote::Error.
template <class Work>
auto guarded(const std::string& location, const std::string& address, Work work) {
  try {
    return work();
  } catch (const pqxx::pqxx_exception&) {
    rethrow(location, address);
  }
}

}  // namespace posevote::postgres
