#include "posevote/evaluate/paper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/made_dataset.hpp"

namespace posevote {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

ReportSection reproduce_made(const std::string& name, const MadeDataset& made) {
  return reproduce(name, load_dataset(made.folder()), make_method("default", {}));
}

TEST(Reproduce, Table1PutsThePapersNumbersBesideOurs) {
  MadeDataset made(1);
  made.add_test("table2 weak", 0);
  const Table table = reproduce_made("table1", made).tables.at(0);
  ASSERT_EQ(table.rows.size(), 5U);
  EXPECT_EQ(table.rows[0][1], "500");
  EXPECT_EQ(table.rows[4][3], "783");
  EXPECT_GT(std::stoi(table.rows[0][2]), 0);
  EXPECT_THAT(table.note, HasSubstr("1 recognised"));
}

TEST(Reproduce, Fig5GroupsByTheValueOfTheTest) {
  MadeDataset made(1);
  made.add_test("yaw", 0, {{"yaw", 180}});
  made.add_test("yaw", -1, {{"yaw", 90}});
  made.add_test("scale", 0, {{"scale", 1}});
  const ReportSection section = reproduce_made("fig5", made);
  ASSERT_EQ(section.tables.size(), 2U);
  const auto& rows = section.tables[0].rows;
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0][0], "90.00");
  EXPECT_EQ(rows[1][2], "1");
  EXPECT_EQ(section.charts.size(), 2U);
}

TEST(Reproduce, Table2CountsByObjectAndBackground) {
  MadeDataset made(3);
  for (const char* group : {"homogeneous", "weak", "strong"})
    for (int cover = 0; cover < 2; ++cover) made.add_test(group, cover);
  const ReportSection section = reproduce_made("table2", made);
  ASSERT_EQ(section.tables.size(), 3U);
  ASSERT_EQ(section.tables[0].rows.size(), 3U);
  EXPECT_THAT(section.tables[0].rows[2],
              ElementsAre("all", StartsWith("100 %"), StartsWith("100 %"), StartsWith("100 %")));
}

TEST(Reproduce, Fig8AveragesOverTheGroup) {
  MadeDataset made(1);
  made.add_test("occlusion obj 00", 0, {{"occlusion", 0}});
  made.add_test("occlusion obj 90", -1, {{"occlusion", 90}});
  const Table table = reproduce_made("fig8", made).tables.at(0);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][3], "100.0 %");
  EXPECT_EQ(table.rows[1][1], "0");
}

TEST(Reproduce, Table3ReadsTheResolutionFromTheGroup) {
  MadeDataset made(1);
  made.add_test("table 4mp", 0);
  made.add_test("table 8mp", 0);
  const Table table = reproduce_made("table3", made).tables.at(0);
  ASSERT_EQ(table.rows.size(), 4U);
  EXPECT_EQ(table.rows[1][1], "8");
  EXPECT_EQ(table.rows[1][4], "1.0");
}

TEST(Reproduce, AccumulatorHasARowForEverySize) {
  MadeDataset made(1);
  made.add_test("g", 0);
  const Table table = reproduce_made("accumulator", made).tables.at(0);
  ASSERT_EQ(table.rows.size(), 8U);
  EXPECT_EQ(table.rows[3][0], "10");
  EXPECT_EQ(table.rows[3][2], "1");
}

TEST(Reproduce, RefusesADatasetWithoutTheGroups) {
  MadeDataset made(1);
  made.add_test("g", 0);
  for (const std::string name : {"fig5", "table2", "fig8", "table3"}) {
    try {
      static_cast<void>(reproduce_made(name, made));
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("dataset made: it has no group"));
    }
  }
  EXPECT_THROW(static_cast<void>(reproduce_made("table4", made)), Error);
}

TEST(ResultsFor, NamesWhatTheGroupsAllow) {
  MadeDataset made(1);
  made.add_test("table2 homogeneous", 0);
  made.add_test("yaw", 0);
  EXPECT_THAT(results_for(load_dataset(made.folder())), ElementsAre("fig5", "table2"));
}

}  // namespace
}  // namespace posevote
