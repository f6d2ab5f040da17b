// What every sub-command of `posevote` shares.
//
// A sub-command is one file with one function
//   void add_NAME(CLI::App& app, CommandContext& context);
// that adds itself to `app` with its options and a callback. The callback throws posevote::Error
// when what was asked for cannot be done (one sentence on standard error, exit status 1) and
// CLI::ParseError, e.g. by `wrong_usage`, when the command line is wrong (exit status 2).
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace posevote::cli {

struct CommandContext {
  int exit_status = 0;  ///< set to 1 by a command that went on after a part of its work failed
};

/// Adds a sub-command whose help ends with `examples`, one line each.
CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& description,
                      const std::string& examples);

/// One sentence on standard error: "posevote: <sentence>".
void print_error(const std::string& sentence);

/// The command line is wrong: exit status 2.
[[noreturn]] void wrong_usage(const std::string& sentence);

/// Adds all sub-commands; the one place that knows them.
void add_commands(CLI::App& app, CommandContext& context);

}  // namespace posevote::cli
