// The server that test_server.sh started, and databases on it.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <pqxx/pqxx>
#include <string>

#include "posevote/store/made_views.hpp"

namespace posevote::postgres {

class TestServer {
 public:
  /// Skips the test when there is none: ctest starts it.
  TestServer() {
    std::ifstream file(POSEVOTE_TEST_SERVER);
    std::getline(file, folder_);
    std::getline(file, port_);
  }
  [[nodiscard]] bool runs() const { return !port_.empty(); }

  /// On the Unix socket, where everybody is let in.
  [[nodiscard]] std::string address(const std::string& database,
                                    const std::string& user = "tester") const {
    return "postgresql://" + user + "@/" + database + "?host=" + folder_ + "&port=" + port_;
  }
  /// On loopback, where a password is needed.
  [[nodiscard]] std::string loopback(const std::string& database, const std::string& login) const {
    return "postgresql://" + login + "@127.0.0.1:" + port_ + "/" + database;
  }

  [[nodiscard]] std::string socket_path() const { return folder_ + "/.s.PGSQL." + port_; }

  /// Runs `sql` as superuser, each statement for itself.
  pqxx::result run(const std::string& database, const std::string& sql) const {
    pqxx::connection connection(address(database));
    const pqxx::quiet_errorhandler quiet(connection);
    return pqxx::nontransaction(connection).exec(sql);
  }
  /// Makes the database unless it is there.
  void make(const std::string& database) const {
    if (run("postgres", "SELECT 1 FROM pg_database WHERE datname = '" + database + "'").empty())
      run("postgres", "CREATE DATABASE \"" + database + "\" TEMPLATE template0");
  }
  /// Breaks all connections to the database but the one that does it.
  void break_connections(const std::string& database) const {
    run(database,
        "SELECT pg_terminate_backend(pid, 60000) FROM pg_stat_activity WHERE datname = "
        "current_database() AND pid <> pg_backend_pid()");
  }

 private:
  std::string folder_, port_;
};

/// A test with a database of its own.
class ServerTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!server_.runs()) GTEST_SKIP() << "no test server; run ctest";
    server_.make(database_);
  }
  void TearDown() override {
    if (server_.runs()) server_.run("postgres", "DROP DATABASE \"" + database_ + "\" WITH (FORCE)");
  }

  TestServer server_;
  ScratchFolder folder_;  // its name is unique
  std::string database_ = folder_.path.filename().string();
};

}  // namespace posevote::postgres
