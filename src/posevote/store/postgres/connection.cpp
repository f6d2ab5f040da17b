#include "posevote/store/postgres/connection.hpp"

#include <algorithm>

#include "posevote/store/address.hpp"
#include "posevote/store/stored_view.hpp"

namespace posevote::postgres {
namespace {

/// The server's words as a part of one sentence, without secrets.
std::string words_of(const std::exception& error, const std::string& address) {
  std::string words = without_passwords(error.what(), address);
  std::ranges::replace(words, '\n', ' ');
  while (!words.empty() && (words.back() == ' ' || words.back() == '.')) words.pop_back();
  return words;
}

[[noreturn]] void rethrow_sql(const pqxx::sql_error& error, const std::string& location,
                              const std::string& words) {
  const std::string state = error.sqlstate(), kind = state.substr(0, 2);
  if (dynamic_cast<const pqxx::insufficient_privilege*>(&error) || state == "25006")
    throw_database_error(
        ErrorCode::io, location,
        "cannot be read or changed like that: this user has not been given the right (" + words +
            ")");
  if (state == "55P03" || kind == "40")
    throw_database_error(ErrorCode::io, location, "is in use by another program; try again");
  if (dynamic_cast<const pqxx::insufficient_resources*>(&error) || kind == "53")
    throw_database_error(ErrorCode::io, location,
                         "cannot be written: the server has no space, memory or connection "
                         "left; nothing was changed");
  if (kind == "57" || kind == "08")
    throw_database_error(ErrorCode::io, location, "is no longer connected: " + words);
  if (state == "54000" || state == "22001")
    throw_database_error(ErrorCode::invalid_argument, location, "cannot take a picture that large");
  throw_database_error(ErrorCode::database_unusable, location, "cannot be used: " + words);
}

}  // namespace

std::string complete_address(const std::string& address, const PostgresOptions& options) {
  std::string complete = address;
  const std::size_t login = address.find_first_of("@/", address.find("://") + 3);
  const bool in_login = login != std::string::npos && address[login] == '@';
  char separator = address.find('?', in_login ? login : 0) == std::string::npos ? '?' : '&';
  const auto add = [&](const std::string& name, const std::string& value) {
    if (address.find(name + "=") != std::string::npos) return;
    complete += separator + name + "=" + value;
    separator = '&';
  };
  add("connect_timeout", std::to_string(options.connect_timeout_s));
  add("tcp_user_timeout", "15000");
  add("keepalives_idle", "5");
  add("keepalives_interval", "3");
  add("keepalives_count", "3");
  add("client_encoding", "UTF8");
  add("fallback_application_name", "posevote");
  return complete;
}

void rethrow(const std::string& location, const std::string& address) {
  try {
    throw;
  } catch (const pqxx::sql_error& error) {
    rethrow_sql(error, location, words_of(error, address));
  } catch (const pqxx::in_doubt_error&) {
    throw_database_error(
        ErrorCode::io, location,
        "lost its connection while a change was being finished; look whether it was made, and make "
        "it again if not");
  } catch (const pqxx::broken_connection& error) {
    throw_database_error(ErrorCode::io, location, "cannot be reached: " + words_of(error, address));
  } catch (const pqxx::failure& error) {
    throw_database_error(ErrorCode::io, location,
                         "does not answer as it should: " + words_of(error, address));
  } catch (const pqxx::argument_error& error) {
    throw_database_error(ErrorCode::invalid_argument, location,
                         "cannot be opened: " + words_of(error, address));
  } catch (const std::exception& error) {
    throw_database_error(ErrorCode::database_unusable, location,
                         "cannot be used: " + words_of(error, address));
  }
}

}  // namespace posevote::postgres
