// posevote explain: why an object was found in a picture, or where its evidence died.
#include <cstdio>
#include <iostream>

#include "command.hpp"
#include "database.hpp"
#include "pictures.hpp"
#include "posevote/json/recognition_json.hpp"
#include "posevote/recognize/explain.hpp"
#include "posevote/recognize/trace.hpp"
#include "posevote/render/draw_explanation.hpp"
#include "prepared_recognizer.hpp"
#include "settings.hpp"

namespace posevote::cli {
namespace {

struct ExplainArguments {
  std::string image, database, draw, preset = "default", features;
  std::vector<std::string> objects, settings;
  bool json = false;
};

void print_text(const Explanation& e) {
  std::printf("%s: %s\n", e.object.c_str(), e.found ? "found" : "not found");
  for (const auto& [what, how_much] : stages_of(e))
    std::printf("  %-44s %6s\n", what.c_str(), how_much.c_str());
  std::printf("  %s: %s", e.found ? "because" : "ended", e.reason.c_str());
  if (!e.option.empty()) std::printf(" (option %s)", e.option.c_str());
  std::printf("\n");
}

std::unique_ptr<Recognizer> open_recognizer(const ExplainArguments& arguments) {
  const auto store = open_database(arguments.database, Access::existing);
  RecognizeOptions options = make_preset(arguments.preset);
  choose_features(options.feature, store.get(), arguments.features);
  apply_settings(list_options(options), arguments.settings);
  require_features(options.feature, *store);
  const std::int64_t version = store->version();
  return make_recognizer(*store, version, store->load(), options);
}

/// FILE for one object; FILE with the object's name before the ending for several.
std::string picture_path(const ExplainArguments& arguments, const std::string& object,
                         std::size_t objects) {
  if (objects == 1) return arguments.draw;
  const std::size_t dot = arguments.draw.rfind('.');
  return arguments.draw.substr(0, dot) + "-" + object + arguments.draw.substr(dot);
}

void run(ExplainArguments arguments) {
  const auto opened = open_recognizer(arguments);
  const Recognizer& recognizer = *opened;
  const cv::Mat image = load_picture(arguments.image).image;
  if (arguments.objects.empty())
    for (const ObjectModel& object : recognizer.models()->objects())
      arguments.objects.push_back(object.name);
  const Trace trace = recognizer.trace(image);
  for (const std::string& object : arguments.objects) {
    const Explanation explanation = explain(trace, recognizer.options(), object);
    if (arguments.json)
      std::cout << to_line(to_json(explanation)) << '\n';
    else
      print_text(explanation);
    if (arguments.draw.empty()) continue;
    const std::string file = picture_path(arguments, object, arguments.objects.size());
    save_picture(file, draw_explanation(image, explanation));
    if (!arguments.json) std::cout << "  drawn in " << file << "\n";
  }
}

}  // namespace

void add_explain(CLI::App& app, CommandContext&) {
  auto arguments = std::make_shared<ExplainArguments>();
  CLI::App* command =
      add_command(app, "explain", "Say why an object is found in a picture, or why not",
                  "  posevote explain scene.jpg --object mug\n"
                  "  posevote explain scene.jpg --object mug --draw why.png    matches and votes\n"
                  "  posevote explain scene.jpg --json    a line for each object");
  ExplainArguments& a = *arguments;
  command->add_option("image", a.image, "Picture")->required()->type_name("IMAGE");
  command->add_option("--object", a.objects, "Objects to ask for; default: all")->type_name("NAME");
  command
      ->add_option("--draw", a.draw,
                   "Draw the matches, the accumulator's votes and the strongest pose")
      ->type_name("FILE")
      ->check([](const std::string& file) {
        return file.ends_with(".png") || file.ends_with(".jpg") ? "" : "must end with .png or .jpg";
      });
  command->add_flag("--json", a.json, "One line of JSON for each object");
  add_database(*command, a.database);
  add_preset(*command, a.preset);
  add_features(*command, a.features);
  add_settings(*command, a.settings);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace posevote::cli
