#include "posevote/evaluate/table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace posevote {
namespace {

Table small_table() {
  Table table;
  table.header = {"name", "n"};
  table.rows = {{"mug", "12"}, {"tête", "3"}, {"short"}};
  return table;
}

TEST(Table, AlignsNamesLeftAndNumbersRight) {
  EXPECT_EQ(small_table().to_text(),
            "name    n\n"
            "mug    12\n"
            "tête    3\n"
            "short\n");
}

TEST(Table, WritesMarkdown) {
  Table table = small_table();
  table.title = std::string("Title");
  table.rows = {{"a|b", "1"}};
  table.note = "Note.";
  EXPECT_EQ(table.to_markdown(), "### Title\n\n| name | n |\n|---|---:|\n| a\\|b | 1 |\n\nNote.\n");
}

TEST(Table, EscapesHtml) {
  Table table = small_table();
  table.rows = {{"<script>", "1"}};
  const std::string html = table.to_html();
  EXPECT_NE(html.find("<td>&lt;script&gt;</td>"), std::string::npos);
  EXPECT_EQ(html.find("<script>"), std::string::npos);
}

TEST(Fixed, WritesWhatIsNoNumberToo) {
  EXPECT_EQ(fixed(1.25, 1), "1.2");
  EXPECT_EQ(fixed(std::nan(""), 1), "-");
  EXPECT_EQ(fixed(-std::numeric_limits<double>::infinity(), 1), "-inf");
  EXPECT_EQ(percent(0.973), "97.3 %");
  EXPECT_EQ(percent(std::nan("")), "-");
}

}  // namespace
}  // namespace posevote
