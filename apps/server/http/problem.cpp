#include "http/problem.hpp"

#include <nlohmann/json.hpp>

namespace posevote::server {
namespace {

/// The one table of HTTP statuses for the library's errors.
int status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::invalid_argument:
      return 400;
    case ErrorCode::not_found:
      return 404;
    case ErrorCode::already_exists:
    case ErrorCode::feature_mismatch:
      return 409;
    case ErrorCode::unreadable_image:
    case ErrorCode::unusable_view:
      return 422;
    case ErrorCode::unsupported:
      return 501;
    case ErrorCode::database_unusable:
    case ErrorCode::io:
      break;
  }
  return 500;
}

}  // namespace

Problem invalid(const std::string& sentence) {
  return {400, "invalid_argument", sentence};
}
Problem not_found(const std::string& sentence) {
  return {404, "not_found", sentence};
}
Problem conflict(const std::string& sentence) {
  return {409, "conflict", sentence};
}
Problem too_many(const std::string& sentence) {
  return {429, "too_many", sentence};
}
Problem busy() {
  return {503, "busy", "too much is being computed at the moment; try again in a few seconds"};
}

Problem to_problem(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const Problem& problem) {
    return problem;
  } catch (const Error& known) {
    return {status_of(known.code()), to_string(known.code()), known.what()};
  } catch (const std::bad_alloc&) {
    return {503, "busy", "there is not enough memory for this; try a smaller picture"};
  } catch (const std::exception& unforeseen) {
    return {500, "internal", std::string("internal error: ") + unforeseen.what()};
  } catch (...) {
    return {500, "internal", "internal error"};
  }
}

std::string problem_json(const Problem& problem) {
  const nlohmann::ordered_json json{
      {"error", {{"code", problem.code()}, {"message", problem.what()}}}};
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace posevote::server
