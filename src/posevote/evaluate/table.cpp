#include "posevote/evaluate/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace posevote {
namespace {

std::size_t width_of(const std::string& text) {
  // Bytes 10xxxxxx continue a character of UTF-8.
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string cell(const std::vector<std::string>& row, std::size_t column) {
  return column < row.size() ? row[column] : std::string();
}

std::string text_line(const std::vector<std::string>& row, const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t column = 0; column < widths.size(); ++column) {
    const std::string text = cell(row, column);
    const std::size_t padding = widths[column] - width_of(text);
    line += column == 0 ? text + std::string(padding, ' ') : std::string(2 + padding, ' ') + text;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string markdown_line(const std::vector<std::string>& row, std::size_t columns) {
  std::string line = "|";
  for (std::size_t column = 0; column < columns; ++column) {
    std::string text = cell(row, column);
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
      text.insert(at, 1, '\\');
    line += " " + text + " |";
  }
  return line + "\n";
}

}  // namespace

std::string Table::to_text() const {
  std::vector<std::size_t> widths;
  for (std::size_t column = 0; column < header.size(); ++column) {
    std::size_t width = width_of(header[column]);
    for (const auto& row : rows) width = std::max(width, width_of(cell(row, column)));
    widths.push_back(width);
  }
  std::string text = title.empty() ? "" : title + "\n";
  text += text_line(header, widths);
  for (const auto& row : rows) text += text_line(row, widths);
  return text + (note.empty() ? "" : note + "\n");
}

std::string Table::to_markdown() const {
  std::string text = title.empty() ? "" : "### " + title + "\n\n";
  text += markdown_line(header, header.size()) + "|";
  for (std::size_t column = 0; column < header.size(); ++column)
    text += column == 0 ? "---|" : "---:|";
  text += "\n";
  for (const auto& row : rows) text += markdown_line(row, header.size());
  return text + (note.empty() ? "" : "\n" + note + "\n");
}

std::string Table::to_html() const {
  const auto line = [&](const std::vector<std::string>& row, const char* begin, const char* end) {
    std::string text = "<tr>";
    for (std::size_t column = 0; column < header.size(); ++column)
      text += begin + escape_html(cell(row, column)) + end;
    return text + "</tr>\n";
  };
  std::string text = title.empty() ? "" : "<h3>" + escape_html(title) + "</h3>\n";
  text += "<div class=\"table\"><table>\n<thead>" + line(header, "<th>", "</th>") +
          "</thead>\n<tbody>\n";
  for (const auto& row : rows) text += line(row, "<td>", "</td>");
  text += "</tbody></table></div>\n";
  return text + (note.empty() ? "" : "<p class=\"note\">" + escape_html(note) + "</p>\n");
}

std::string fixed(double value, int decimals) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char buffer[400];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr;
  return {buffer, end};
}

std::string percent(double share, int decimals) {
  return std::isnan(share) ? "-" : fixed(100 * share, decimals) + " %";
}

std::string escape_html(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace posevote
