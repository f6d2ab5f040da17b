// posevote options: every option that --set takes.
#include <iostream>

#include "command.hpp"
#include "posevote/json/recognition_json.hpp"
#include "posevote/recognize/recognizer.hpp"
#include "posevote/teach/teacher.hpp"
#include "settings.hpp"

namespace posevote::cli {
namespace {

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string allowed(const OptionField& field) {
  if (std::holds_alternative<bool*>(field.value)) return "true or false";
  if (std::holds_alternative<std::string*>(field.value)) {
    std::string words;
    for (const std::string& choice : field.choices) words += (words.empty() ? "" : ", ") + choice;
    return words;
  }
  return number(field.min) + " to " + number(field.max) +
         (field.unit.empty() ? "" : " " + field.unit);
}

Json to_json(const OptionField& field, const std::string& prefix) {
  Json json{{"name", prefix + field.name}, {"value", field.text()}};
  if (std::holds_alternative<int*>(field.value) || std::holds_alternative<double*>(field.value)) {
    json["min"] = field.min;
    json["max"] = field.max;
  }
  if (!field.unit.empty()) json["unit"] = field.unit;
  if (!field.choices.empty()) json["choices"] = field.choices;
  json["help"] = field.help;
  return json;
}

void print(const OptionList& list, const std::string& prefix, bool json) {
  for (const OptionField& field : list.fields()) {
    if (json)
      std::cout << to_line(to_json(field, prefix)) << '\n';
    else
      std::cout << "  " << prefix << field.name << " = " << field.text() << "    ("
                << allowed(field) << ")\n      " << field.help << '\n';
  }
}

void run(const std::string& preset, bool json) {
  RecognizeOptions recognize = make_preset(preset);
  TeachOptions teach;
  if (!json) std::cout << "Options of recognize, bench and evaluate, preset " << preset << ":\n";
  print(list_options(recognize), "", json);
  if (!json) std::cout << "\nOptions of teach (there \"teach.\" may be left out) and evaluate:\n";
  print(list_options(teach), "teach.", json);
}

}  // namespace

void add_options(CLI::App& app, CommandContext&) {
  struct Arguments {
    std::string preset = "default";
    bool json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = add_command(app, "options", "List all options that --set takes",
                                  "  posevote options\n"
                                  "  posevote options --preset paper\n"
                                  "  posevote recognize scene.jpg --set match.max_ratio=0.75");
  add_preset(*command, arguments->preset);
  command->add_flag("--json", arguments->json, "One line of JSON for each option");
  command->callback([arguments] { run(arguments->preset, arguments->json); });
}

}  // namespace posevote::cli
