// Sub-commands of `posevote objects` that stand in files of their own.
#pragma once

#include "command.hpp"

namespace posevote::cli {

void add_rebuild(CLI::App& objects, CommandContext& context);
void add_diff(CLI::App& objects);
void add_merge(CLI::App& objects);
void add_impostors(CLI::App& objects, CommandContext& context);

}  // namespace posevote::cli
