// A table of texts, for terminals, Markdown and HTML.
#pragma once

#include <string>
#include <vector>

namespace posevote {

struct Table {
  std::string title;  ///< may be empty
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< may be shorter than the header
  std::string note;                            ///< a sentence or two below, may be empty

  /// Columns padded to equal width, the first to the left, all others to the right. Widths count
  /// characters of UTF-8.
  [[nodiscard]] std::string to_text() const;
  /// GitHub's Markdown; a | in a cell is escaped.
  [[nodiscard]] std::string to_markdown() const;
  [[nodiscard]] std::string to_html() const;
};

/// `value` with that many decimals; "-" when it is NaN.
[[nodiscard]] std::string fixed(double value, int decimals);
/// A share as "97.3 %"; "-" when it is NaN.
[[nodiscard]] std::string percent(double share, int decimals = 1);
/// The text with &, <, >, " and ' escaped for HTML.
[[nodiscard]] std::string escape_html(const std::string& text);

}  // namespace posevote
