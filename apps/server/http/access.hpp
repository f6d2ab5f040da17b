// Who may use the server: token, cookie, and browsers that speak for other sites.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "http/message.hpp"
#include "http/router.hpp"

namespace posevote::server {

struct AccessOptions {
  std::string token;               ///< empty: none is needed
  bool any_host = false;           ///< serve under any host name: when a token protects
  std::vector<std::string> hosts;  ///< host names, without port, beside loopback's
  bool https = false;              ///< browsers reach the server by https:// only
};

/// Safe for many threads.
class AccessControl {
 public:
  explicit AccessControl(AccessOptions options);

  /// Throws Problem 403 for a request to a host name that is not ours (a page elsewhere may point
  /// its own name here), and for one that would change something and that a browser sends for
  /// another site.
  void check_origin(const Request& request) const;
  /// Throws Problem 401 unless the request has shown the token, by header or cookie.
  void check_token(const Request& request) const;

  [[nodiscard]] bool token_needed() const { return !options_.token.empty(); }
  [[nodiscard]] bool authenticated(const Request& request) const;

  /// The Set-Cookie header for whoever knows the token. Throws Problem 401, and 429 after ten wrong
  /// ones within a minute.
  [[nodiscard]] std::string login(const std::string& token);
  [[nodiscard]] std::string logout() const;

 private:
  void count_failure();
  [[nodiscard]] std::string set_cookie(const std::string& value, int seconds) const;

  AccessOptions options_;
  std::string cookie_;  ///< its value; derived from the token, so that it survives a restart
  std::mutex mutex_;
  std::vector<double> failures_;  ///< when, seconds
};

/// Takes the same time wherever the two differ.
[[nodiscard]] bool equal_in_constant_time(const std::string& a, const std::string& b);

/// 127.0.0.0/8, ::1 or localhost.
[[nodiscard]] bool is_loopback(const std::string& host);

/// `bytes` random bytes as hex digits.
[[nodiscard]] std::string random_hex(int bytes);

}  // namespace posevote::server
