#include "logic/health.hpp"

#include <gtest/gtest.h>

namespace posevote::logic {
namespace {

TEST(Health, IsQuietBeforeTheFirstPicture) {
  const HealthReport report = Health().report(100);
  EXPECT_EQ(report.pictures, 0u);
  EXPECT_EQ(report.rate_hz, 0);
}

TEST(Health, AveragesOverItsWindowAndCountsFromTheStart) {
  Health health(10);
  health.add(100, 99.9, 50, 0);
  health.add(115, 114.7, 100, 3);
  health.add(116, 115.9, 200, 1);
  const HealthReport report = health.report(116);
  EXPECT_DOUBLE_EQ(report.rate_hz, 0.2);
  EXPECT_DOUBLE_EQ(report.mean_time_ms, 150);
  EXPECT_NEAR(report.mean_latency_ms, 200, 1e-6);
  EXPECT_NEAR(report.worst_latency_ms, 300, 1e-6);
  EXPECT_EQ(report.pictures, 3u);
  EXPECT_EQ(report.dropped, 4u);
}

TEST(Health, ForgetsOldPicturesWhenNoneCome) {
  Health health(10);
  health.add(100, 100, 1, 0);
  EXPECT_EQ(health.report(111).rate_hz, 0);
}

TEST(Health, BeginsAnewWhenTheClockIsSetBack) {
  Health health(10);
  health.add(1000, 999, 1, 0);
  health.add(5, 4.9, 1, 0);
  EXPECT_DOUBLE_EQ(health.report(5).rate_hz, 0.1);
  EXPECT_EQ(health.report(5).pictures, 2u);
}

TEST(Health, NamesAProblemUntilAGoodPictureComes) {
  Health health;
  health.add_problem("no pixels");
  EXPECT_EQ(health.report(0).last_problem, "no pixels");
  EXPECT_EQ(health.report(0).refused, 1u);
  health.add(1, 1, 1, 0);
  EXPECT_EQ(health.report(1).last_problem, "");
}

}  // namespace
}  // namespace posevote::logic
