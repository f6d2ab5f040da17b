#include "command_tree.hpp"

#include <sstream>

namespace posevote::cli {
namespace {

/// The words of "TEXT:{surf,sift}".
std::vector<std::string> choices_of(const std::string& type) {
  const std::size_t begin = type.find('{'), end = type.find('}');
  std::vector<std::string> choices;
  if (begin == std::string::npos || end == std::string::npos) return choices;
  std::istringstream words(type.substr(begin + 1, end - begin - 1));
  for (std::string word; std::getline(words, word, ',');) choices.push_back(word);
  return choices;
}

OptionNode describe(const CLI::Option& option) {
  OptionNode node;
  const std::string type = option.get_type_name();
  node.name = option.get_positional() ? option.get_name(true) : option.get_name();
  node.choices = choices_of(type);
  if (option.get_items_expected_max() > 0) node.value = type.substr(0, type.find_first_of(":{ "));
  if (node.name == "--help,-h" || node.name == "-h,--help") node.name = "--help";
  node.description = option.get_description();
  node.required = option.get_required();
  node.repeated = option.get_items_expected_max() > 1 && option.get_allow_extra_args();
  return node;
}

void collect(const CLI::App& app, const std::vector<std::string>& path,
             std::vector<CommandNode>& commands) {
  CommandNode node;
  node.path = path;
  node.description = app.get_description();
  node.footer = app.get_footer();
  for (const CLI::Option* option : app.get_options())
    (option->get_positional() ? node.positionals : node.options).push_back(describe(*option));
  const auto children = app.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* child : children) node.children.push_back(child->get_name());
  commands.push_back(std::move(node));
  for (const CLI::App* child : children) {
    std::vector<std::string> below = path;
    below.push_back(child->get_name());
    collect(*child, below, commands);
  }
}

}  // namespace

std::vector<CommandNode> list_commands(const CLI::App& app) {
  std::vector<CommandNode> commands;
  collect(app, {}, commands);
  return commands;
}

}  // namespace posevote::cli
