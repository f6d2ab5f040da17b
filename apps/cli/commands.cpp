#include "commands.hpp"

#include <iostream>

#include "command.hpp"

namespace posevote::cli {

void add_commands(CLI::App& app, CommandContext& context) {
  for (const auto add : {add_teach, add_recognize, add_explain, add_batch, add_objects, add_sync})
    add(app, context);
#ifdef POSEVOTE_WITH_SERVER
  add_serve(app, context);
#endif
  for (const auto add :
       {add_evaluate, add_dataset, add_bench, add_options, add_completion, add_man})
    add(app, context);
}

CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& description,
                      const std::string& examples) {
  CLI::App* command = app.add_subcommand(name, description);
  if (!examples.empty()) command->footer("Examples:\n" + examples);
  return command;
}

void print_error(const std::string& sentence) {
  std::cerr << "posevote: " << sentence << '\n';
}

void wrong_usage(const std::string& sentence) {
  throw CLI::ValidationError(sentence, CLI::ExitCodes::ValidationError);
}

}  // namespace posevote::cli
