// The commands with their options as plain data: what completion and the manual page are made from.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace posevote::cli {

struct OptionNode {
  std::string name;   ///< "--mask", or "IMAGE" of a positional one
  std::string value;  ///< what it takes, e.g. "FOLDER"; "" for a flag
  std::vector<std::string> choices;
  std::string description;
  bool required = false, repeated = false;
};

struct CommandNode {
  std::vector<std::string> path;  ///< {"objects", "list"}; empty for the program itself
  std::string description, footer;
  std::vector<OptionNode> options, positionals;
  std::vector<std::string> children;  ///< names
};

/// The program first, then every command, those that contain others before them.
[[nodiscard]] std::vector<CommandNode> list_commands(const CLI::App& app);

}  // namespace posevote::cli
