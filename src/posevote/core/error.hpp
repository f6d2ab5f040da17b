// The one exception of the library and the one list of reasons.
#pragma once

#include <stdexcept>
#include <string>

namespace posevote {

/// Why something could not be done. Adapters map these to exit status, HTTP status or Python class.
enum class ErrorCode {
  invalid_argument,   ///< an option, a name or a shape is out of range; the message says which
  unreadable_image,   ///< the file is missing, not an image, or larger than the limit
  unusable_view,      ///< the picture was read, but no object can be taught from it; has advice
  not_found,          ///< no such object, view or file
  already_exists,     ///< the new name is taken
  feature_mismatch,   ///< features of another kind or with other parameters may not be mixed
  database_unusable,  ///< not a posevote database, damaged, or of a newer version
  io,                 ///< disk full, no permission, connection lost
  unsupported,        ///< this build lacks the part that was asked for
};

/// Stable lower-case name, e.g. "not_found".
[[nodiscard]] const char* to_string(ErrorCode code) noexcept;

/// Thrown by every public function that cannot do what it promises. `what()` is one sentence that
/// names the file or option and says what to do.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace posevote
