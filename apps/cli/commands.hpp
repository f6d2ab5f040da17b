// All sub-commands; each stands in the file of its name.
#pragma once

#include "command.hpp"

namespace posevote::cli {

void add_batch(CLI::App& app, CommandContext& context);
void add_bench(CLI::App& app, CommandContext& context);
void add_completion(CLI::App& app, CommandContext& context);
void add_dataset(CLI::App& app, CommandContext& context);
void add_evaluate(CLI::App& app, CommandContext& context);
void add_explain(CLI::App& app, CommandContext& context);
void add_man(CLI::App& app, CommandContext& context);
void add_objects(CLI::App& app, CommandContext& context);
void add_options(CLI::App& app, CommandContext& context);
void add_recognize(CLI::App& app, CommandContext& context);
void add_serve(CLI::App& app, CommandContext& context);
void add_sync(CLI::App& app, CommandContext& context);
void add_teach(CLI::App& app, CommandContext& context);

}  // namespace posevote::cli
