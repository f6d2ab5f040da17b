// posevote dataset: makes a data set for `evaluate` and finds its mistakes.
#include <iostream>
#include <memory>

#include "command.hpp"
#include "posevote/core/error.hpp"
#include "posevote/evaluate/assistant.hpp"

namespace posevote::cli {
namespace {

struct DatasetArguments {
  std::string folder, image, group;
  std::vector<std::string> objects;
  double visible = 1;
  bool optional = false, force = false;
};

void init(const DatasetArguments& arguments) {
  const auto file = std::filesystem::path(arguments.folder) / "dataset.json";
  if (std::filesystem::exists(file) && !arguments.force)
    throw Error(ErrorCode::already_exists,
                file.string() + " exists already; --force makes it anew and loses its boxes");
  replace_file(file, make_dataset(arguments.folder));
  const Dataset dataset = load_dataset(arguments.folder);
  std::cout << file.string() << ": " << dataset.objects.size() << " objects, "
            << dataset.tests.size() << " tests\n";
}

void add(const DatasetArguments& arguments) {
  DatasetAddition addition{arguments.image, arguments.group, {}};
  for (const std::string& text : arguments.objects) {
    TruthObject truth = parse_truth(text);
    truth.visible = arguments.visible;
    truth.optional = arguments.optional;
    addition.objects.push_back(truth);
  }
  const auto file = dataset_file(arguments.folder);
  const Dataset dataset = load_dataset(file);
  if (!std::filesystem::exists(dataset.path(addition.image)))
    throw Error(ErrorCode::not_found, dataset.path(addition.image).string() +
                                          " does not exist; pictures are named relative to the "
                                          "data set's folder");
  replace_file(file, add_to_dataset(file, addition));
}

void check(const DatasetArguments& arguments, CommandContext& context) {
  int errors = 0, hints = 0;
  for (const DatasetProblem& problem : check_dataset(arguments.folder)) {
    std::cout << (problem.is_error ? "error: " : "hint: ") << problem.where
              << (problem.where.empty() ? "" : ": ") << problem.what << '\n';
    ++(problem.is_error ? errors : hints);
  }
  std::cout << errors << " errors, " << hints << " hints\n";
  if (errors > 0) context.exit_status = 1;
}

void add_folder(CLI::App& command, DatasetArguments& arguments) {
  command.add_option("DATASET", arguments.folder, "The folder of the data set")->required();
}

}  // namespace

void add_dataset(CLI::App& app, CommandContext& context) {
  auto arguments = std::make_shared<DatasetArguments>();
  DatasetArguments& a = *arguments;
  CLI::App* command = add_command(
      app, "dataset",
      "Make a data set for evaluate from folders of pictures, and find its mistakes",
      "  posevote dataset init my-set        (my-set/train/NAME/*.jpg, my-set/test/GROUP/*.jpg)\n"
      "  posevote dataset add my-set test/table/1.jpg --object mug=120,80,200,240\n"
      "  posevote dataset check my-set");
  command->require_subcommand(1);

  CLI::App* init_command = command->add_subcommand(
      "init",
      "Write dataset.json: train/NAME/PICTURE are views (background.* and *-mask.* beside "
      "them are understood), test/GROUP/PICTURE are tests");
  add_folder(*init_command, a);
  init_command->add_flag("--force", a.force, "Replace a dataset.json that is there");
  init_command->callback([arguments] { init(*arguments); });

  CLI::App* add_command = command->add_subcommand("add", "Add a test picture, or objects in it");
  add_folder(*add_command, a);
  add_command->add_option("IMAGE", a.image, "The picture, relative to the data set's folder")
      ->required();
  add_command
      ->add_option("--object", a.objects, "An object in the picture and its box, px; repeatable")
      ->type_name("NAME=X,Y,W,H")
      ->allow_extra_args(false);
  add_command->add_option("--group", a.group, "The group of the test");
  add_command->add_option("--visible", a.visible, "Visible share of these objects")
      ->check(CLI::Range(0.0, 1.0));
  add_command->add_flag("--optional", a.optional, "These objects are neither asked for nor wrong");
  add_command->callback([arguments] { add(*arguments); });

  CLI::App* check_command = command->add_subcommand(
      "check", "Find mistakes: missing files, boxes outside, names never taught, ...");
  add_folder(*check_command, a);
  check_command->callback([arguments, &context] { check(*arguments, context); });
}

}  // namespace posevote::cli
