// `--set NAME=VALUE`, `--preset` and `--features`: the library's options on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "posevote/core/options.hpp"

namespace posevote::cli {

/// Adds `--set` (repeatable).
void add_settings(CLI::App& command, std::vector<std::string>& settings);
void add_preset(CLI::App& command, std::string& preset);
/// Adds `--features`; left empty when it is not given.
void add_features(CLI::App& command, std::string& kind);

/// Sets one field after the other; `prefix` may stand before the names. What cannot be set is wrong
/// usage.
void apply_settings(const OptionList& list, const std::vector<std::string>& settings,
                    const std::string& prefix = "");

}  // namespace posevote::cli
