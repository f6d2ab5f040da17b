// Errors as HTTP tells them.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

#include "posevote/core/error.hpp"

namespace posevote::server {

/// What a request cannot have, with its HTTP status and a stable code (see openapi.yaml, Error).
class Problem : public std::runtime_error {
 public:
  Problem(int status, std::string code, const std::string& sentence)
      : std::runtime_error(sentence), status_(status), code_(std::move(code)) {}
  [[nodiscard]] int status() const noexcept { return status_; }
  [[nodiscard]] const std::string& code() const noexcept { return code_; }

 private:
  int status_;
  std::string code_;
};

[[nodiscard]] Problem invalid(const std::string& sentence);    ///< 400
[[nodiscard]] Problem not_found(const std::string& sentence);  ///< 404
[[nodiscard]] Problem conflict(const std::string& sentence);   ///< 409
[[nodiscard]] Problem too_many(const std::string& sentence);   ///< 429
[[nodiscard]] Problem busy();                                  ///< 503

/// The problem that an exception of whatever kind is; anything unforeseen is 500 "internal".
[[nodiscard]] Problem to_problem(const std::exception_ptr& error);

/// {"error": {"code", "message"}}
[[nodiscard]] std::string problem_json(const Problem& problem);

}  // namespace posevote::server
