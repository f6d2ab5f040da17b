#include "posevote/store/feature_record.hpp"

#include <sstream>

#include "posevote/core/error.hpp"

namespace posevote {

FeatureRecord record_features(FeatureOptions options) {
  FeatureRecord record;
  record.signature = options.signature();
  const OptionList list = list_options(options);
  for (const OptionField& field : list.fields())
    record.settings += field.name + "=" + field.text() + "\n";
  return record;
}

FeatureOptions parse_settings(const FeatureRecord& record) {
  FeatureOptions options;
  const OptionList list = list_options(options);
  std::istringstream lines(record.settings);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos) continue;
    try {
      list.set(line.substr(0, equals), line.substr(equals + 1));
    } catch (const Error&) {
      continue;  // a setting of another version
    }
  }
  return options;
}

FeatureOptions recorded_options(const FeatureRecord& record) {
  FeatureOptions options = parse_settings(record);
  if (options.signature() != record.signature)
    throw Error(ErrorCode::feature_mismatch,
                "the database holds features '" + record.signature +
                    "', which this version does not make; run: posevote objects rebuild");
  return options;
}

std::string why_not_mixed(const FeatureRecord& present, const FeatureRecord& wanted) {
  return "holds features '" + present.signature + "', which must not be mixed with '" +
         wanted.signature +
         "'; use the same features, or convert the database: posevote objects rebuild";
}

}  // namespace posevote
