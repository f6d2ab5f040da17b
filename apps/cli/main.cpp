// The program `posevote`: reads the command line and turns errors into one sentence and an exit
// status (0 done, 1 something asked for could not be done, 2 the command line is wrong).
#include <exception>
#include <iostream>
#include <opencv2/core/utils/logger.hpp>

#include "command.hpp"
#include "posevote/core/error.hpp"

namespace {

using namespace posevote::cli;

int run(int argc, char** argv) {
  CLI::App app("Teaches objects and finds them again in pictures.", "posevote");
  app.set_version_flag("--version", "posevote " POSEVOTE_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  CommandContext context;
  add_commands(app, context);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    print_error(std::string(error.what()) + "; see posevote --help");
    return 2;
  }
  return context.exit_status;
}

}  // namespace

int main(int argc, char** argv) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  try {
    return run(argc, argv);
  } catch (const posevote::Error& error) {
    print_error(error.what());
  } catch (const std::bad_alloc&) {
    print_error("there is not enough memory for this; try smaller pictures");
  } catch (const std::exception& error) {
    print_error(std::string("internal error: ") + error.what());
  }
  return 1;
}
