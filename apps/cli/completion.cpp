// posevote completion: the shells' scripts, made from the commands themselves.
#include <algorithm>
#include <iostream>

#include "command.hpp"
#include "command_tree.hpp"

namespace posevote::cli {
namespace {

constexpr const char* list_names = "posevote objects list --names 2>/dev/null";

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

/// "/objects/list"; "" for the program.
std::string place(const CommandNode& command) {
  return command.path.empty() ? "" : "/" + joined(command.path, "/");
}

bool takes_object(const CommandNode& command) {
  return std::ranges::any_of(command.positionals,
                             [](const OptionNode& option) { return option.name == "NAME"; });
}

/// For a text between single quotes, in every one of the shells.
std::string quotable(std::string text) {
  std::erase(text, '\'');
  return text;
}

/// Case lines that walk `at` down the tree of commands, word by word.
std::string walk(const std::vector<CommandNode>& commands) {
  std::vector<std::string> places;
  for (const CommandNode& command : commands)
    if (!command.path.empty()) places.push_back(place(command));
  return joined(places, "|");
}

/// Case lines for the word after an option that takes a value.
std::string after_options(const std::vector<CommandNode>& commands, const char* offer_begin,
                          const char* offer_end, const char* offer_files) {
  std::string text;
  for (const CommandNode& command : commands)
    for (const OptionNode& option : command.options)
      if (!option.value.empty())
        text += "    '" + place(command) + " " + option.name + "') " +
                (option.choices.empty() ? offer_files
                                        : offer_begin + joined(option.choices, " ") + offer_end) +
                " return ;;\n";
  return text;
}

std::string bash_script(const std::vector<CommandNode>& commands) {
  std::string text =
      "# bash completion of posevote, made by: posevote completion bash\n"
      "_posevote() {\n"
      "  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} at= words= i\n"
      "  COMPREPLY=()\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    case \"$at/${COMP_WORDS[i]}\" in\n"
      "      " +
      walk(commands) +
      ") at=$at/${COMP_WORDS[i]} ;;\n"
      "    esac\n"
      "  done\n"
      "  case \"$at $before\" in\n" +
      after_options(commands, "COMPREPLY=($(compgen -W '", "' -- \"$current\"));", "") +
      "  esac\n"
      "  case \"$at\" in\n";
  for (const CommandNode& command : commands) {
    std::vector<std::string> words = command.children;
    for (const OptionNode& option : command.options) words.push_back(option.name);
    text += "    '" + place(command) + "') words='" + joined(words, "\n") + "'" +
            (takes_object(command) ? "$'\\n'$(" + std::string(list_names) + ")" : "") + " ;;\n";
  }
  return text +
         "  esac\n"
         "  local IFS=$'\\n'\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "  COMPREPLY=(\"${COMPREPLY[@]// /\\\\ }\")\n"
         "}\n"
         "complete -o default -o bashdefault -F _posevote posevote\n";
}

std::string zsh_script(const std::vector<CommandNode>& commands) {
  std::string text =
      "#compdef posevote\n"
      "# zsh completion of posevote, made by: posevote completion zsh\n"
      "_posevote() {\n"
      "  local at= i\n"
      "  local -a items\n"
      "  for ((i = 2; i < CURRENT; ++i)); do\n"
      "    case \"$at/${words[i]}\" in\n"
      "      " +
      walk(commands) +
      ") at=$at/${words[i]} ;;\n"
      "    esac\n"
      "  done\n"
      "  case \"$at ${words[CURRENT-1]}\" in\n" +
      after_options(commands, "compadd -- ", ";", "_files;") +
      "  esac\n"
      "  case \"$at\" in\n";
  for (const CommandNode& command : commands) {
    text += "    '" + place(command) + "') items=(";
    for (const CommandNode& child : commands)
      if (!child.path.empty() && joined(child.path, "/") == joined(command.path, "/") +
                                                                (command.path.empty() ? "" : "/") +
                                                                child.path.back())
        text += "'" + child.path.back() + ":" + quotable(child.description) + "' ";
    for (const OptionNode& option : command.options)
      text += "'" + option.name + ":" + quotable(option.description) + "' ";
    text += ")";
    if (takes_object(command)) text += "; compadd -- ${(f)\"$(" + std::string(list_names) + ")\"}";
    text += " ;;\n";
  }
  return text +
         "  esac\n"
         "  _describe posevote items\n"
         "  _files\n"
         "}\n"
         "if [[ $zsh_eval_context[-1] == loadautofunc ]]; then _posevote \"$@\"; else compdef "
         "_posevote "
         "posevote; fi\n";
}

std::string fish_condition(const CommandNode& command) {
  std::vector<std::string> conditions;
  for (const std::string& word : command.path)
    conditions.push_back("__fish_seen_subcommand_from " + word);
  if (command.path.empty()) conditions.push_back("__fish_use_subcommand");
  return joined(conditions, "; and ");
}

std::string fish_script(const std::vector<CommandNode>& commands) {
  std::string text = "# fish completion of posevote, made by: posevote completion fish\n";
  for (const CommandNode& command : commands) {
    const std::string begin = "complete -c posevote -n '" + fish_condition(command);
    for (const CommandNode& child : commands)
      if (child.path.size() == command.path.size() + 1 &&
          std::equal(command.path.begin(), command.path.end(), child.path.begin()))
        text += begin +
                (command.path.empty()
                     ? ""
                     : "; and not __fish_seen_subcommand_from " + joined(command.children, " ")) +
                "' -f -a " + child.path.back() + " -d '" + quotable(child.description) + "'\n";
    for (const OptionNode& option : command.options)
      text += begin + "' -l " + option.name.substr(2) + (option.value.empty() ? "" : " -r") +
              (option.choices.empty() ? "" : " -f -a '" + joined(option.choices, " ") + "'") +
              " -d '" + quotable(option.description) + "'\n";
    if (takes_object(command)) text += begin + "' -a '(" + list_names + ")'\n";
  }
  return text;
}

}  // namespace

void add_completion(CLI::App& app, CommandContext&) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = add_command(
      app, "completion", "Print a script that completes commands and names in your shell",
      "  source <(posevote completion bash)\n"
      "  posevote completion zsh > ~/.zfunc/_posevote\n"
      "  posevote completion fish > ~/.config/fish/completions/posevote.fish");
  command->add_option("SHELL", *shell, "Your shell")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->callback([shell, &app] {
    const auto commands = list_commands(app);
    std::cout << (*shell == "bash"  ? bash_script(commands)
                  : *shell == "zsh" ? zsh_script(commands)
                                    : fish_script(commands));
  });
}

}  // namespace posevote::cli
