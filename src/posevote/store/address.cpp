#include "posevote/store/address.hpp"

#include <algorithm>
#include <string_view>

namespace posevote {
namespace {

constexpr const char* hidden = "***";

/// Hides PASSWORD of "user:PASSWORD@host" in text[begin, end); returns the new end.
std::size_t hide_login(std::string& text, std::size_t begin, std::size_t end) {
  // A password may hold @ and / although it should not: the last @ before the query counts.
  const std::size_t query = std::min(text.find('?', begin), end);
  const std::size_t at = text.rfind('@', query == 0 ? 0 : query - 1);
  const std::size_t colon = text.find(':', begin);
  if (at == std::string::npos || at < begin || colon >= at) return end;
  text.replace(colon + 1, at - colon - 1, hidden);
  return end - (at - colon - 1) + 3;
}

/// Hides the values of "password=..." and "sslpassword=..." in text[begin, end).
std::size_t hide_parameters(std::string& text, std::size_t begin, std::size_t end) {
  constexpr std::string_view name = "password=";
  for (std::size_t at = text.find(name, begin); at < end; at = text.find(name, at)) {
    at += name.size();
    const std::size_t stop = std::min(text.find('&', at), end);
    text.replace(at, stop - at, hidden);
    end = end - (stop - at) + 3;
  }
  return end;
}

}  // namespace

std::string without_passwords(const std::string& text) {
  std::string result = text;
  for (const std::string_view scheme : {"postgresql://", "postgres://"})
    for (std::size_t at = result.find(scheme); at != std::string::npos;
         at = result.find(scheme, at)) {
      at += scheme.size();
      std::size_t end = std::min(result.find_first_of(" \t\n'\"", at), result.size());
      end = hide_login(result, at, end);
      at = hide_parameters(result, at, end);
    }
  return result;
}

}  // namespace posevote
