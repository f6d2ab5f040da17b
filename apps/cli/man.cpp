// posevote man: the manual page, made from the commands themselves.
#include <iostream>
#include <sstream>

#include "command.hpp"
#include "command_tree.hpp"

namespace posevote::cli {
namespace {

/// Text that troff prints as it is.
std::string roff(const std::string& text) {
  std::string escaped;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\')
      escaped += "\\e";
    else if (c == '-')
      escaped += "\\-";
    else
      escaped += c;
    line_begins = c == '\n';
  }
  return escaped;
}

std::string usage(const CommandNode& command) {
  std::string text = "posevote";
  for (const std::string& word : command.path) text += " " + word;
  for (const OptionNode& option : command.positionals) {
    const std::string name = option.name + (option.repeated ? "..." : "");
    text += option.required ? " " + name : " [" + name + "]";
  }
  return text + (command.children.empty() ? " [OPTION]..." : " COMMAND");
}

std::string items(const std::vector<OptionNode>& options) {
  std::string text;
  for (const OptionNode& option : options) {
    std::string choices;
    for (const std::string& choice : option.choices)
      choices += (choices.empty() ? "" : ", ") + choice;
    const bool named = option.name.starts_with("-");
    text += ".TP\n.B " + roff(option.name) +
            (named && !option.value.empty() ? " \\fI" + roff(option.value) + "\\fR" : "") + "\n" +
            roff(option.description) + (choices.empty() ? "" : "; one of " + roff(choices)) + ".\n";
  }
  return text;
}

std::string section(const CommandNode& command) {
  std::string text = ".SS " + roff(usage(command)) + "\n" + roff(command.description) + ".\n" +
                     items(command.positionals) + items(command.options);
  if (!command.footer.empty()) text += ".PP\n.nf\n" + roff(command.footer) + "\n.fi\n";
  return text;
}

std::string page(const std::vector<CommandNode>& commands) {
  std::string text =
      ".TH POSEVOTE 1 \"\" \"posevote " POSEVOTE_VERSION
      "\" \"User Commands\"\n"
      ".SH NAME\nposevote \\- teaches objects and finds them again in pictures\n"
      ".SH SYNOPSIS\n.B posevote\n.I COMMAND\n[OPTION]...\n"
      ".SH DESCRIPTION\n"
      "Recognises particular objects - this box, that cover - in pictures, with their place, "
      "turn and scale: features vote for poses in a Hough space, and the clusters are "
      "verified by homographies. Objects are taught from one or more pictures of them.\n"
      ".SH COMMANDS\n";
  for (const CommandNode& command : commands)
    if (!command.path.empty()) text += section(command);
  return text +
         ".SH EXIT STATUS\n"
         ".TP\n.B 0\nAll that was asked for is done; also when nothing was recognised.\n"
         ".TP\n.B 1\nSomething asked for could not be done; one sentence on standard error says "
         "what.\n"
         ".TP\n.B 2\nThe command line is wrong.\n"
         ".SH ENVIRONMENT\n"
         ".TP\n.B POSEVOTE_DB\nThe database when there is no \\-\\-db.\n"
         ".TP\n.B XDG_DATA_HOME\nElse the database is posevote/objects.db in this folder, by "
         "default "
         "~/.local/share.\n";
}

}  // namespace

void add_man(CLI::App& app, CommandContext&) {
  CLI::App* command = add_command(app, "man", "Print the manual page", "  posevote man | man -l -");
  command->callback([&app] { std::cout << page(list_commands(app)); });
}

}  // namespace posevote::cli
