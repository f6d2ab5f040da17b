// Addresses of databases without their secrets.
#pragma once

#include <string>

namespace posevote {

/// `text` with the password of every postgresql:// address in it replaced by "***".
[[nodiscard]] std::string without_passwords(const std::string& text);

}  // namespace posevote
