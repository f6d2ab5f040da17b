// Addresses of databases without their secrets.
#pragma once

#include <string>
#include <vector>

namespace posevote {

/// `text` with the passwords of every postgresql:// address in it replaced by "***". Where a
/// password ends is libpq's rule, and what a mistake in writing one leaves visible is hidden, too.
[[nodiscard]] std::string without_passwords(const std::string& text);

/// The same, and without the passwords of `address` wherever they stand as a word of their own, as
/// they are written there and as they are meant.
[[nodiscard]] std::string without_passwords(const std::string& text, const std::string& address);

/// The arguments of a program. In `argv`, which every user of the machine can list, passwords are
/// overwritten.
[[nodiscard]] std::vector<std::string> take_arguments(int argc, char** argv);

}  // namespace posevote
