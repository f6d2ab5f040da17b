#include "posevote/store/object_name.hpp"

#include <cstdint>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

constexpr std::size_t max_bytes = 200;

[[noreturn]] void fail(const std::string& reason) {
  throw Error(ErrorCode::invalid_argument, "an object's name " + reason);
}

/// The code point at `at`, which moves behind it. Refuses what is not well-formed UTF-8: stray or
/// missing continuation bytes, overlong forms, surrogates, values above U+10FFFF.
std::uint32_t next_code_point(const std::string& text, std::size_t& at) {
  const auto lead = static_cast<std::uint8_t>(text[at++]);
  if (lead < 0x80) return lead;
  const int more = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : 1;
  constexpr std::uint32_t smallest[] = {0, 0x80, 0x800, 0x10000};
  std::uint32_t point = lead & (0x3fU >> more);
  if (lead < 0xc0 || lead > 0xf7) fail("must be valid UTF-8 text");
  for (int i = 0; i < more; ++i, ++at) {
    if (at >= text.size() || (static_cast<std::uint8_t>(text[at]) & 0xc0) != 0x80)
      fail("must be valid UTF-8 text");
    point = point << 6 | (static_cast<std::uint8_t>(text[at]) & 0x3f);
  }
  if (point < smallest[more] || point > 0x10ffff || (point >= 0xd800 && point <= 0xdfff))
    fail("must be valid UTF-8 text");
  return point;
}

}  // namespace

void check_object_name(const std::string& name) {
  if (name.empty()) fail("must not be empty");
  if (name.size() > max_bytes)
    fail("must not be longer than " + std::to_string(max_bytes) + " bytes, this one has " +
         std::to_string(name.size()));
  for (std::size_t at = 0; at < name.size();) {
    const std::uint32_t point = next_code_point(name, at);
    if (point < 0x20 || (point >= 0x7f && point < 0xa0)) fail("must not hold control characters");
  }
  if (name.front() == ' ' || name.back() == ' ') fail("must neither begin nor end with a space");
}

}  // namespace posevote
