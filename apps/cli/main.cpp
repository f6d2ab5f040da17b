// The program `posevote`: reads the command line and turns errors into one sentence and an exit
// status (0 done, 1 something asked for could not be done, 2 the command line is wrong).
#include <algorithm>
#include <csignal>
#include <exception>
#include <iostream>
#include <opencv2/core/utils/logger.hpp>

#include "command.hpp"
#include "posevote/core/arguments.hpp"
#include "posevote/core/error.hpp"
#include "posevote/core/options.hpp"
#include "posevote/store/address.hpp"

namespace {

using namespace posevote::cli;

/// The command that the command line ended in.
const CLI::App& deepest(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : deepest(*parsed.front());
}

std::string full_name(const CLI::App& command) {
  return command.get_parent() ? full_name(*command.get_parent()) + " " + command.get_name()
                              : command.get_name();
}

/// The first word that is neither command nor option of `command`, among the program's arguments.
std::string stray_word(const CLI::App& command, int argc, char** argv) {
  const CLI::App* parent = command.get_parent();
  const char** end = const_cast<const char**>(argv) + argc;
  const char** word = const_cast<const char**>(argv) + 1;
  if (parent) word = std::find(word, end, command.get_name()) + 1;
  return word < end ? *word : "";
}

/// What is wrong, in words that help: which command or option was meant.
std::string explain(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  const CLI::App& command = deepest(app);
  std::vector<std::string> known;
  std::string kind = "command", stray;
  if (dynamic_cast<const CLI::RequiredError*>(&error) && command.get_require_subcommand_min() > 0) {
    for (const CLI::App* child : command.get_subcommands([](const CLI::App*) { return true; }))
      known.push_back(child->get_name());
    stray = stray_word(command, argc, argv);
  } else if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
    for (const CLI::Option* option : command.get_options()) known.push_back(option->get_name());
    const auto extras = command.remaining();
    stray = extras.empty() ? "" : extras.front();
    kind = stray.starts_with("-") ? "option" : "argument";
  }
  if (stray.empty()) return error.what();
  const std::string nearest = posevote::nearest_word(stray, known);
  return (kind == "argument" ? "there is one argument too many, '" : "there is no " + kind + " '") +
         stray + "'" + (nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
}

int run(int argc, char** argv) {
  CLI::App app("Teaches objects and finds them again in pictures.", "posevote");
  app.set_version_flag("--version", "posevote " POSEVOTE_VERSION, "Print the version and exit");
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer(
      "Begin with:\n"
      "  posevote teach poster poster.jpg    teach an object from a picture of it\n"
      "  posevote recognize scene.jpg        find it in another\n"
      "posevote COMMAND --help says more.");
  CommandContext context;
  add_commands(app, context);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    const std::string hint = "; see " + full_name(deepest(app)) + " --help";
    print_error(posevote::without_passwords(explain(app, error, argc, argv) + hint));
    return 2;
  }
  std::cout.flush();
  if (!std::cout)
    throw posevote::Error(posevote::ErrorCode::io,
                          "cannot write to standard output; is the disk full?");
  return context.exit_status;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments = posevote::take_arguments(argc, argv);
  std::vector<char*> words = posevote::argv_of(arguments);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error to tell, not to die of
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  try {
    return run(argc, words.data());
  } catch (const posevote::Error& error) {
    print_error(error.what());
  } catch (const std::bad_alloc&) {
    print_error("there is not enough memory for this; try smaller pictures");
  } catch (const std::exception& error) {
    print_error(std::string("internal error: ") + error.what());
  }
  return 1;
}
