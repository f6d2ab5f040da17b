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

/// The options in a record; settings that this version does not know stay at their defaults.
[[nodiscard]] FeatureOptions parse_settings(const FeatureRecord& record);

/// The same, when this version makes features of the recorded signature with them; else throws
/// Error{feature_mismatch}.
[[nodiscard]] FeatureOptions recorded_options(const FeatureRecord& record);

/// Why features of the one record must not be added to a database with the other; the subject, the
/// database, is left out.
[[nodiscard]] std::string why_not_mixed(const FeatureRecord& present, const FeatureRecord& wanted);

}  // namespace posevote
