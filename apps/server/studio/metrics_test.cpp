#include "studio/metrics.hpp"

#include <gmock/gmock.h>

namespace posevote::server {
namespace {

using testing::HasSubstr;

TEST(Metrics, HistogramsAreCumulative) {
  Histogram histogram;
  for (const double seconds : {0.0005, 0.001, 0.0011, 100.0}) histogram.observe(seconds);
  std::ostringstream out;
  histogram.write(out, "x", "a=\"b\"");
  EXPECT_THAT(out.str(), HasSubstr("x_bucket{a=\"b\",le=\"0.001\"} 2\n"));
  EXPECT_THAT(out.str(), HasSubstr("x_bucket{a=\"b\",le=\"0.0025\"} 3\n"));
  EXPECT_THAT(out.str(), HasSubstr("x_bucket{a=\"b\",le=\"5\"} 3\n"));
  EXPECT_THAT(out.str(), HasSubstr("x_bucket{a=\"b\",le=\"+Inf\"} 4\n"));
  EXPECT_THAT(out.str(), HasSubstr("x_count{a=\"b\"} 4\n"));
}

TEST(Metrics, LargeNumbersKeepAllTheirDigits) {
  std::ostringstream out;
  write_metric(out, "x", "gauge", "An x.", 123456789.0);
  EXPECT_EQ(out.str(), "# HELP x An x.\n# TYPE x gauge\nx 123456789\n");
}

TEST(Metrics, RecognitionsCount) {
  Metrics metrics;
  RecognitionResult result;
  result.counts.features = 500;
  result.detections.resize(2);
  metrics.count_recognition(result, true);
  metrics.count_recognition(result, false);
  std::ostringstream out;
  metrics.write(out);
  EXPECT_THAT(out.str(), HasSubstr("posevote_recognitions_total{of=\"live\"} 1\n"));
  EXPECT_THAT(out.str(), HasSubstr("posevote_features_total 1000\n"));
  EXPECT_THAT(out.str(), HasSubstr("posevote_detections_total 4\n"));
}

}  // namespace
}  // namespace posevote::server
