#include "posevote/core/error.hpp"

namespace posevote {

const char* to_string(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::invalid_argument:
      return "invalid_argument";
    case ErrorCode::unreadable_image:
      return "unreadable_image";
    case ErrorCode::unusable_view:
      return "unusable_view";
    case ErrorCode::not_found:
      return "not_found";
    case ErrorCode::already_exists:
      return "already_exists";
    case ErrorCode::feature_mismatch:
      return "feature_mismatch";
    case ErrorCode::database_unusable:
      return "database_unusable";
    case ErrorCode::io:
      return "io";
    case ErrorCode::unsupported:
      return "unsupported";
  }
  return "unknown";
}

}  // namespace posevote
