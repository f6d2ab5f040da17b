// posevote evaluate: how good is it on these pictures?
#include <algorithm>
#include <fstream>
#include <iostream>
#include <opencv2/core/utility.hpp>

#include "command.hpp"
#include "posevote/core/error.hpp"
#include "posevote/evaluate/requirement.hpp"
#include "posevote/evaluate/results.hpp"
#include "progress.hpp"

namespace posevote::cli {
namespace {

struct EvaluateArguments {
  std::vector<std::string> datasets;
  std::string preset = "default";
  std::vector<std::string> settings;
  std::vector<std::string> groups;
  std::string negatives, dump, require;
  int limit = 0, jobs = 0;
  bool json = false;
};

struct Method {
  RecognizeOptions recognize;
  TeachOptions teach;
};

// Settings that begin with "teach." are the teacher's, all others the recogniser's. Both use the
// same features unless teach.feature.* says otherwise.
Method read_method(const EvaluateArguments& arguments) {
  Method method;
  method.recognize = make_preset(arguments.preset);
  std::vector<std::pair<std::string, std::string>> teach_settings;
  const OptionList list = list_options(method.recognize);
  for (const std::string& setting : arguments.settings) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos) wrong_usage("--set needs NAME=VALUE, not '" + setting + "'");
    const std::string name = setting.substr(0, equals), value = setting.substr(equals + 1);
    if (name.starts_with("teach."))
      teach_settings.emplace_back(name.substr(6), value);
    else
      list.set(name, value);
  }
  method.teach.feature = method.recognize.feature;
  const OptionList teach_list = list_options(method.teach);
  for (const auto& [name, value] : teach_settings) teach_list.set(name, value);
  return method;
}

// A folder without dataset.json stands for all data sets in it.
std::vector<std::filesystem::path> expand_datasets(const std::vector<std::string>& given) {
  std::vector<std::filesystem::path> paths;
  for (const std::filesystem::path path : given) {
    std::vector<std::filesystem::path> inside;
    if (std::filesystem::is_directory(path) && !std::filesystem::exists(path / "dataset.json"))
      for (const auto& entry : std::filesystem::directory_iterator(path))
        if (std::filesystem::exists(entry.path() / "dataset.json")) inside.push_back(entry.path());
    std::ranges::sort(inside);
    if (inside.empty()) inside.push_back(path);
    paths.insert(paths.end(), inside.begin(), inside.end());
  }
  return paths;
}

Progress show(ProgressBar& bar) {
  return [&bar](std::size_t, std::size_t) { bar.advance(); };
}

std::vector<TestOutcome> run_with_bar(const Dataset& dataset, const RecognizeFunction& recognize,
                                      int jobs) {
  ProgressBar bar(dataset.name + ": recognising", dataset.tests.size());
  return run_tests(dataset, recognize, jobs, show(bar));
}

TaughtDataset teach_with_bar(const Dataset& dataset, const TeachOptions& options, int jobs) {
  std::size_t views = 0;
  for (const DatasetObject& object : dataset.objects) views += object.views.size();
  ProgressBar bar(dataset.name + ": teaching", views);
  return teach_dataset(dataset, options, jobs, show(bar));
}

Evaluation evaluate(const Dataset& dataset, const Dataset& negatives, const Method& method,
                    int jobs) {
  const TaughtDataset taught = teach_with_bar(dataset, method.teach, jobs);
  const Recognizer recognizer(taught.models, method.recognize);
  const auto recognize = [&](const cv::Mat& picture) { return recognizer.recognize(picture); };
  Evaluation evaluation =
      make_evaluation(dataset, taught, run_with_bar(dataset, recognize, jobs), jobs);
  evaluation.negatives = negatives;
  evaluation.negative_outcomes = run_with_bar(negatives, recognize, jobs);
  return evaluation;
}

void print_one(const Evaluation& evaluation) {
  std::cout << evaluation.dataset.name << ": " << evaluation.objects << " objects, "
            << evaluation.views << " views, " << evaluation.features << " features, taught in "
            << fixed(evaluation.teach_ms / 1000, 1) << " s\n\n"
            << group_table(evaluation).to_text() << '\n'
            << time_table(evaluation).to_text() << '\n'
            << ranking_table(evaluation).to_text();
  if (!evaluation.negative_outcomes.empty()) {
    const Summary negative = summarize("", evaluation.negatives, evaluation.negative_outcomes);
    std::cout << '\n'
              << evaluation.negatives.name << ": " << negative.images << " pictures, "
              << negative.false_positives << " false positives\n";
  }
  const Table confusion = confusion_table(evaluation);
  if (!confusion.rows.empty()) std::cout << '\n' << confusion.to_text();
  if (!evaluation.refused.empty()) std::cout << '\n' << refused_table(evaluation).to_text();
}

void print(const std::vector<Evaluation>& evaluations, bool json) {
  if (json) {
    for (const Evaluation& evaluation : evaluations) std::cout << to_json(evaluation) << '\n';
  } else if (evaluations.size() == 1) {
    print_one(evaluations.front());
  } else {
    std::cout << set_table(evaluations).to_text();
  }
  std::cout << std::flush;
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream stream(path, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw Error(ErrorCode::io, "cannot write " + path);
}

void report_problems(const Evaluation& evaluation, CommandContext& context) {
  for (const auto* outcomes : {&evaluation.outcomes, &evaluation.negative_outcomes})
    for (const TestOutcome& outcome : *outcomes) {
      if (outcome.error.empty()) continue;
      print_error(outcome.error);
      context.exit_status = 1;
    }
}

void run(const EvaluateArguments& arguments, CommandContext& context) {
  const Method method = read_method(arguments);
  const auto requirements = parse_requirements(arguments.require);
  if (thread_count(arguments.jobs) > 1) cv::setNumThreads(1);
  Dataset negatives;
  if (!arguments.negatives.empty()) negatives = load_dataset(arguments.negatives);

  std::vector<Evaluation> evaluations;
  for (const auto& path : expand_datasets(arguments.datasets)) {
    const Dataset dataset = select_tests(load_dataset(path), arguments.groups, arguments.limit);
    evaluations.push_back(evaluate(dataset, negatives, method, arguments.jobs));
    report_problems(evaluations.back(), context);
  }
  print(evaluations, arguments.json);

  std::string lines;
  for (const Evaluation& evaluation : evaluations) {
    if (!arguments.dump.empty()) lines += to_json_lines(evaluation);
    const Summary whole =
        summarize(evaluation.dataset.name, evaluation.dataset, evaluation.outcomes);
    for (const std::string& failure : unmet_requirements(requirements, whole)) {
      print_error(failure);
      context.exit_status = 1;
    }
  }
  if (!arguments.dump.empty()) write_file(arguments.dump, lines);
}

}  // namespace

void add_evaluate(CLI::App& app, CommandContext& context) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = add_command(
      app, "evaluate", "Teach a data set's objects, recognise its tests and print how good it was",
      "  posevote evaluate data/demo\n"
      "  posevote evaluate my-sets/* --negatives my-negatives\n"
      "  posevote evaluate data/demo --groups 'occluded*' --json\n"
      "  posevote evaluate data/demo --require recall=0.95,false_positives=0");
  EvaluateArguments& a = *arguments;
  command
      ->add_option("DATASET", a.datasets,
                   "Folders with a dataset.json, or folders of such folders. One: a table of its "
                   "groups; several: a line for each")
      ->required();
  command->add_option("--preset", a.preset, "Options to begin with")
      ->check(CLI::IsMember(preset_names()))
      ->capture_default_str();
  command->add_option("--set", a.settings, "Change an option; teach.NAME is the teacher's")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command->add_option("--groups", a.groups, "Only groups that match; wildcards * and ?")
      ->type_name("PATTERN")
      ->allow_extra_args(false);
  command->add_option("--limit", a.limit, "Only so many tests, evenly spread; 0: all")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--jobs", a.jobs, "Pictures at a time; 0: one for each core")
      ->check(CLI::Range(0, 1024));
  command->add_option("--negatives", a.negatives,
                      "A data set without any of the objects: every answer in it is false");
  command->add_option("--require", a.require,
                      "Fail unless met, e.g. recall=0.95,precision=0.99,false_positives=0");
  command
      ->add_option("--dump", a.dump,
                   "Write every detection and every miss to FILE, a line of JSON each")
      ->type_name("FILE");
  command->add_flag("--json", a.json, "One line of JSON for each data set");
  command->callback([arguments, &context] { run(*arguments, context); });
}

}  // namespace posevote::cli
