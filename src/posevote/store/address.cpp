#include "posevote/store/address.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string_view>

namespace posevote {
namespace {

constexpr std::string_view hidden = "***";
constexpr auto npos = std::string::npos;

struct Span {
  std::size_t begin, end;
};

/// With %XX for what it stands for.
std::string decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string hex(text.substr(std::min(i + 1, text.size()), 2));
    const bool escaped = text[i] == '%' && hex.size() == 2 &&
                         hex.find_first_not_of("0123456789abcdefABCDEF") == npos;
    result += escaped ? static_cast<char>(std::strtol(hex.c_str(), nullptr, 16)) : text[i];
    if (escaped) i += 2;
  }
  return result;
}

/// The password in "user:password@host...", which begins at `begin`; empty at `begin`: none.
Span login_password(std::string_view text, std::size_t begin) {
  // As libpq reads it, a login ends at the first @ unless a / comes before. One that should have
  // been written otherwise may hold both: then it ends at the last @ of the word.
  const std::size_t first = text.find_first_of("@/", begin);
  const bool login = first != npos && text[first] == '@';
  const std::size_t word_end =
      std::min(text.find_first_of(" \t\n'\"?", login ? first : begin), text.size());
  const std::size_t last = text.substr(0, word_end).rfind('@');
  const std::size_t colon = text.find(':', begin);
  if (last == npos || last < begin || colon >= (login ? first : last)) return {begin, begin};
  return {colon + 1, last};
}

/// Adds the values of "?password=..." and "&sslpassword=..." in text[begin, end).
void add_parameters(std::string_view text, std::size_t begin, std::size_t end,
                    std::vector<Span>& found) {
  text = text.substr(0, end);
  for (std::size_t at = text.find('?', begin); at != npos;) {
    const std::size_t next = text.find('&', at + 1), value = text.find('=', at + 1) + 1;
    const std::size_t stop = std::min(next, text.size());
    if (value != 0 && value <= stop &&
        decoded(text.substr(at + 1, value - at - 2)).ends_with("password")) {
      const bool done = text.substr(value).starts_with(hidden) &&
                        (value + hidden.size() == stop ||
                         text.find_first_of(" '\"", value) == value + hidden.size());
      if (!done) found.push_back({value, stop});
    }
    at = next;
  }
}

std::vector<Span> passwords_in(std::string_view text) {
  std::vector<Span> found;
  const auto scheme_after = [&](std::size_t at) {
    return std::min(text.find("postgresql://", at), text.find("postgres://", at));
  };
  for (std::size_t scheme = scheme_after(0); scheme != npos;) {
    const std::size_t begin = text.find("://", scheme) + 3, next = scheme_after(begin);
    const Span login = login_password(text.substr(0, next), begin);
    if (login.end > begin) found.push_back(login);
    // Within quotes the last one ends the address: a value may hold others.
    const char before = scheme == 0 ? ' ' : text[scheme - 1];
    std::size_t end = std::min(next, text.size());
    if (before == '\'' || before == '"') {
      const std::size_t quote = text.substr(0, end).rfind(before);
      if (quote > begin) end = quote;
    }
    add_parameters(text, login.end, end, found);
    scheme = next;
  }
  return found;
}

/// Replaces `word` by "***", except within longer words.
void hide_word(std::string& text, const std::string& word) {
  const auto joined = [&](std::size_t left) {
    return left + 1 < text.size() && std::isalnum(static_cast<unsigned char>(text[left])) &&
           std::isalnum(static_cast<unsigned char>(text[left + 1]));
  };
  for (std::size_t at = text.find(word); at != npos; at = text.find(word, at)) {
    if ((at > 0 && joined(at - 1)) || joined(at + word.size() - 1)) {
      ++at;
    } else {
      text.replace(at, word.size(), hidden);
      at += hidden.size();
    }
  }
}

/// What of a password an error may quote: all of it, or a part when it holds what separates parts
/// of an address. The longest first.
std::vector<std::string> forms_of(const std::string& password) {
  std::vector<std::string> forms{password, decoded(password)};
  for (std::size_t at = 0; at < password.size();) {
    const std::size_t end = std::min(password.find_first_of("@/:?", at), password.size());
    if (end > at) forms.push_back(password.substr(at, end - at));
    at = end + 1;
  }
  std::ranges::sort(forms, std::ranges::greater(), &std::string::size);
  return forms;
}

}  // namespace

std::string without_passwords(const std::string& text) {
  std::string result;
  std::size_t done = 0;
  for (const Span& span : passwords_in(text)) {
    result.append(text, done, span.begin - done).append(hidden);
    done = span.end;
  }
  return result.append(text, done);
}

std::string without_passwords(const std::string& text, const std::string& address) {
  std::string result = without_passwords(text);
  for (const Span& span : passwords_in(address))
    for (const std::string& form : forms_of(address.substr(span.begin, span.end - span.begin)))
      if (!form.empty()) hide_word(result, form);
  return result;
}

std::vector<std::string> take_arguments(int argc, char** argv) {
  std::vector<std::string> arguments(argv, argv + argc);
  for (int i = 1; i < argc; ++i) {
    const std::string& given = arguments[static_cast<std::size_t>(i)];
    const std::string shown = without_passwords(given);
    if (shown == given) continue;
    std::fill_n(argv[i], given.size(), '\0');
    std::copy_n(shown.begin(), std::min(shown.size(), given.size()), argv[i]);
  }
  return arguments;
}

}  // namespace posevote
