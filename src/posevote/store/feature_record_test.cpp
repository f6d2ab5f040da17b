#include "posevote/store/feature_record.hpp"

#include <gmock/gmock.h>

#include "posevote/store/made_views.hpp"

namespace posevote {
namespace {

using testing::HasSubstr;

TEST(FeatureRecord, OptionsSurviveTheRoundTrip) {
  FeatureOptions options;
  options.kind = "sift";
  options.max_features = 321;
  options.sift.sigma = 1.7;
  const FeatureOptions read = recorded_options(record_features(options));
  EXPECT_EQ(read.kind, "sift");
  EXPECT_EQ(read.max_features, 321);
  EXPECT_EQ(read.sift.sigma, 1.7);
  EXPECT_EQ(record_features(options).signature, options.signature());
}

TEST(FeatureRecord, SettingsOfOtherVersionsAreLeftOut) {
  FeatureRecord record = record_features({});
  record.settings += "surf.colour=blue\nmax_features=-5\nnonsense\n\n";
  EXPECT_EQ(recorded_options(record).max_features, FeatureOptions().max_features);
}

TEST(FeatureRecord, AnotherSignatureIsAnError) {
  FeatureRecord record = record_features({});
  record.signature = "surf64 999";
  EXPECT_THAT(error_of([&] { static_cast<void>(recorded_options(record)); }),
              testing::AllOf(HasSubstr("feature_mismatch"), HasSubstr("surf64 999")));
}

}  // namespace
}  // namespace posevote
