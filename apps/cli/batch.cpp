// posevote batch: many pictures on many processors. The work is done by the Python package on Dask.
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "command.hpp"
#include "commands.hpp"
#include "database.hpp"
#include "posevote/core/arguments.hpp"
#include "posevote/core/error.hpp"
#include "settings.hpp"

namespace posevote::cli {
namespace {

namespace fs = std::filesystem;

struct BatchArguments {
  std::vector<std::string> inputs, settings;
  std::string database, list, out, scheduler, preset = "default";
  int every = 1, workers = 0;
  bool restart = false;
};

/// In a build folder the package lies beside the program's folder.
void find_package() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path packages = program.parent_path().parent_path() / "python";
  if (error || !fs::exists(packages / "posevote" / "batch.py", error)) return;
  const char* present = std::getenv("PYTHONPATH");
  const std::string path = packages.string() + (present ? std::string(":") + present : "");
  setenv("PYTHONPATH", path.c_str(), 1);
}

std::vector<std::string> words_of(const BatchArguments& a) {
  std::vector<std::string> words{POSEVOTE_PYTHON,
                                 "-m",
                                 "posevote.batch",
                                 "--out",
                                 a.out,
                                 "--every",
                                 std::to_string(a.every),
                                 "--workers",
                                 std::to_string(a.workers),
                                 "--preset",
                                 a.preset};
  if (!a.list.empty()) words.insert(words.end(), {"--list", a.list});
  if (!a.scheduler.empty()) words.insert(words.end(), {"--scheduler", a.scheduler});
  if (a.restart) words.emplace_back("--restart");
  for (const std::string& setting : a.settings) words.push_back("--set=" + setting);
  words.emplace_back("--");
  words.insert(words.end(), a.inputs.begin(), a.inputs.end());
  return words;
}

void run(const BatchArguments& arguments) {
  find_package();
  // By the environment: arguments are there for every user of the machine to see.
  setenv("POSEVOTE_DB", database_path(arguments.database).c_str(), 1);
  std::vector<std::string> words = words_of(arguments);
  execv(POSEVOTE_PYTHON, argv_of(words).data());
  throw Error(ErrorCode::unsupported,
              std::string("cannot run " POSEVOTE_PYTHON ", which batch needs: ") +
                  std::strerror(errno) + "; install python3 and python3-posevote");
}

}  // namespace

void add_batch(CLI::App& app, CommandContext&) {
  auto arguments = std::make_shared<BatchArguments>();
  CLI::App* command = add_command(
      app, "batch", "Recognise in many pictures on all processors, or on many machines (Dask)",
      "  posevote batch archive/ --out found.jsonl\n"
      "      stopped and run again, it goes on where it was\n"
      "  find archive -name '*.jpg' | sort | posevote batch --list - --out found.jsonl\n"
      "  posevote batch archive/ --out found.jsonl --scheduler tcp://head:8786 "
      "--db postgresql://robot@head/objects\n"
      "On a terminal it shows the address of Dask's pages: the dashboard where Python's bokeh is\n"
      "installed (Debian 12 has no package of it), else plain pages on workers and tasks.");
  BatchArguments& a = *arguments;
  command->add_option("INPUT", a.inputs, "Pictures, folders of pictures, video files");
  command->add_option("--list", a.list, "FILE with an INPUT a line; -: standard input")
      ->type_name("FILE");
  command->add_option("--out", a.out, "The file of results: a line of JSON for each picture")
      ->type_name("FILE")
      ->required();
  command->add_option("--scheduler", a.scheduler, "A Dask scheduler; default: this machine alone")
      ->type_name("ADDRESS");
  command->add_option("--workers", a.workers, "Processes on this machine; 0: one for each core")
      ->check(CLI::Range(0, 1024));
  command->add_option("--every", a.every, "Of videos, only every N-th frame")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--restart", a.restart, "Begin the file of results again");
  add_preset(*command, a.preset);
  add_settings(*command, a.settings);
  add_database(*command, a.database);
  command->callback([arguments] {
    if (arguments->inputs.empty() && arguments->list.empty())
      wrong_usage("name pictures, folders or videos, or a --list of them");
    run(*arguments);
  });
}

}  // namespace posevote::cli
