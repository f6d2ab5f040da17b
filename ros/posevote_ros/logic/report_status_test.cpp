#include "logic/report_status.hpp"

#include <gtest/gtest.h>

#include <map>

namespace posevote::logic {
namespace {

/// As much of diagnostic_updater's wrapper as the reports use.
struct Status {
  enum Level { OK, WARN };
  Level level = OK;
  std::string message;
  std::map<std::string, std::string> values;
  void summary(Level to, const std::string& text) {
    level = to;
    message = text;
  }
  template <class Value>
  void add(const std::string& key, const Value& value) {
    if constexpr (std::is_arithmetic_v<Value>)
      values[key] = std::to_string(value);
    else
      values[key] = value;
  }
};

TEST(ReportHealth, TheLastProblemGoesBeforeLatency) {
  Status status;
  HealthReport report;
  report.worst_latency_ms = 900;
  report_health(status, report, 500, true);
  EXPECT_EQ(status.level, Status::WARN);
  EXPECT_EQ(status.message, "results come late");
  report.last_problem = "the picture is empty";
  report_health(status, report, 500, true);
  EXPECT_EQ(status.message, "the picture is empty");
}

TEST(ReportHealth, SaysWhetherAnyoneListens) {
  Status status;
  HealthReport report;
  report.dropped = 3;
  report_health(status, report, 500, false);
  EXPECT_EQ(status.level, Status::OK);
  EXPECT_EQ(status.message, "nobody listens");
  EXPECT_EQ(status.values["dropped for newer ones"], "3");
}

TEST(ReportDatabase, AnEmptyOneIsAWarning) {
  Status status;
  DatabaseState database;
  database.location = "objects.db";
  report_database(status, database);
  EXPECT_EQ(status.level, Status::WARN);
  database.objects.resize(2);
  report_database(status, database);
  EXPECT_EQ(status.level, Status::OK);
  EXPECT_EQ(status.message, "2 objects");
  EXPECT_EQ(status.values["location"], "objects.db");
  database.problem = "cannot be reached";
  report_database(status, database);
  EXPECT_EQ(status.level, Status::WARN);
  EXPECT_EQ(status.message, "cannot be reached");
}

}  // namespace
}  // namespace posevote::logic
