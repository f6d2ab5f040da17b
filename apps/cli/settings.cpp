#include "settings.hpp"

#include "command.hpp"
#include "posevote/core/error.hpp"
#include "posevote/recognize/recognizer.hpp"

namespace posevote::cli {

void add_settings(CLI::App& command, std::vector<std::string>& settings) {
  command
      .add_option("--set", settings,
                  "Change an option, e.g. match.max_ratio=0.75; posevote options lists them all")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

void add_preset(CLI::App& command, std::string& preset) {
  command.add_option("--preset", preset, "Options to begin with")
      ->check(CLI::IsMember(preset_names()))
      ->capture_default_str();
}

void add_features(CLI::App& command, std::string& kind) {
  FeatureOptions options;
  const OptionList list = list_options(options);
  for (const OptionField& field : list.fields())
    if (field.name == "kind")
      command
          .add_option("--features", kind,
                      "Kind of features; default: those of the database, else " + field.text())
          ->check(CLI::IsMember(field.choices));
}

void apply_settings(const OptionList& list, const std::vector<std::string>& settings,
                    const std::string& prefix) {
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) wrong_usage("--set needs NAME=VALUE, not '" + setting + "'");
    std::string name = setting.substr(0, equals);
    if (!prefix.empty() && name.starts_with(prefix)) name = name.substr(prefix.size());
    try {
      list.set(name, setting.substr(equals + 1));
    } catch (const Error& error) {
      wrong_usage(std::string("--set: ") + error.what());
    }
  }
}

}  // namespace posevote::cli
