// Which features a database holds, and with which options they were made.
#pragma once

#include <string>

#include "posevote/feature/features.hpp"

namespace posevote {

struct FeatureRecord {
  std::string
      signature;         ///< FeatureOptions::signature(): only equal ones may stand in one database
  std::string settings;  ///< every field of FeatureOptions, one "name=value" per line
};

[[nodiscard]] FeatureRecord record_features(FeatureOptions options);

/// The options of a record; settings that this version does not know are left at their defaults.
/// Throws Error{feature_mismatch} when this version would make features of another signature.
[[nodiscard]] FeatureOptions recorded_options(const FeatureRecord& record);

}  // namespace posevote
