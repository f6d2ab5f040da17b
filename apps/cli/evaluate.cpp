// posevote evaluate: how good is it on these pictures?
#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "command.hpp"
#include "posevote/core/error.hpp"
#include "posevote/evaluate/method.hpp"
#include "posevote/evaluate/paper.hpp"
#include "posevote/evaluate/peer.hpp"
#include "posevote/evaluate/report.hpp"
#include "posevote/evaluate/requirement.hpp"
#include "posevote/evaluate/results.hpp"
#include "posevote/evaluate/sweep.hpp"
#include "progress.hpp"

namespace posevote::cli {
namespace {

struct EvaluateArguments {
  std::vector<std::string> datasets;
  std::string preset = "default";
  std::vector<std::string> settings, groups, tables, sweeps, peers;
  std::string negatives, dump, require, report, markdown;
  int limit = 0, jobs = 0;
  bool json = false;
};

std::vector<std::pair<std::string, std::string>> read_settings(
    const std::vector<std::string>& texts) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    if (equals == std::string::npos) wrong_usage("--set needs NAME=VALUE, not '" + text + "'");
    settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return settings;
}

// One bar at a time: a new task wipes that of the task before.
TaskProgress show_progress() {
  struct State {
    std::string task;
    std::unique_ptr<ProgressBar> bar;
  };
  return [state = std::make_shared<State>()](const std::string& name, std::size_t done,
                                             std::size_t total) {
    if (state->task != name || done == 1) {
      state->task = name;
      state->bar = std::make_unique<ProgressBar>(name, total);
    }
    state->bar->advance();
    if (done == total) state->bar.reset();
  };
}

// A folder without dataset.json stands for all data sets in it but the negatives.
std::vector<std::filesystem::path> expand_datasets(const std::vector<std::string>& given,
                                                   const std::filesystem::path& negatives) {
  const auto is_set = [&](const std::filesystem::path& path) {
    return std::filesystem::exists(path / "dataset.json") &&
           !(std::filesystem::exists(negatives) && std::filesystem::equivalent(path, negatives));
  };
  std::vector<std::filesystem::path> paths;
  for (const std::filesystem::path path : given) {
    std::vector<std::filesystem::path> inside;
    if (std::filesystem::is_directory(path) && !std::filesystem::exists(path / "dataset.json"))
      for (const auto& entry : std::filesystem::directory_iterator(path))
        if (is_set(entry.path())) inside.push_back(entry.path());
    std::ranges::sort(inside);
    if (inside.empty()) inside.push_back(path);
    paths.insert(paths.end(), inside.begin(), inside.end());
  }
  return paths;
}

std::vector<std::string> or_all(const std::vector<std::string>& wanted,
                                const std::vector<std::string>& all) {
  return wanted == std::vector<std::string>{"all"} ? all : wanted;
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream stream(path, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw Error(ErrorCode::io, "cannot write " + path);
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
  if (!evaluation.silhouettes.empty())
    std::cout << '\n'
              << silhouette_table(evaluation.dataset.name, evaluation.silhouettes).to_text();
  if (!evaluation.refused.empty()) std::cout << '\n' << refused_table(evaluation).to_text();
}

void print(const std::vector<Evaluation>& evaluations, const std::vector<ReportSection>& sections,
           bool json) {
  if (json) {
    for (const Evaluation& evaluation : evaluations) std::cout << to_json(evaluation) << '\n';
  } else if (evaluations.size() == 1) {
    print_one(evaluations.front());
  } else if (!evaluations.empty()) {
    std::cout << set_table(evaluations).to_text();
  }
  if (!json && !evaluations.empty() && !sections.empty()) std::cout << '\n';
  for (const ReportSection& section : sections)
    std::cout << (json ? to_json(section) + "\n" : to_text(section));
  std::cout << std::flush;
}

// Tells of unreadable pictures and requirements that are not met.
void report_problems(const Evaluation& evaluation, const std::vector<Requirement>& requirements,
                     CommandContext& context) {
  std::vector<std::string> problems;
  for (const auto* outcomes : {&evaluation.outcomes, &evaluation.negative_outcomes})
    for (const TestOutcome& outcome : *outcomes)
      if (!outcome.error.empty()) problems.push_back(outcome.error);
  const auto unmet = unmet_requirements(
      requirements, summarize(evaluation.dataset.name, evaluation.dataset, evaluation.outcomes));
  problems.insert(problems.end(), unmet.begin(), unmet.end());
  for (const std::string& problem : problems) print_error(problem);
  if (!problems.empty()) context.exit_status = 1;
}

// What one data set gives: the evaluation, unless only tables or sweeps are wanted, and the rest.
void work_on(const Dataset& dataset, const Dataset& negatives, const EvaluateArguments& arguments,
             const Method& method, std::vector<Evaluation>& evaluations,
             std::vector<ReportSection>& sections) {
  for (const std::string& name : or_all(arguments.tables, results_for(dataset)))
    sections.push_back(reproduce(name, dataset, method));
  const bool only_parts = (!arguments.tables.empty() || !arguments.sweeps.empty()) &&
                          arguments.report.empty() && arguments.markdown.empty();
  if (only_parts && arguments.sweeps.empty()) return;
  const TaughtMethod taught(dataset, method);
  for (const std::string& name : or_all(arguments.sweeps, sweep_names()))
    sections.push_back(run_sweep(name, dataset, taught, method));
  if (only_parts) return;
  evaluations.push_back(taught.evaluate(dataset, negatives));
  if (!arguments.report.empty())
    taught.explain_worst(evaluations.back(), ReportOptions().max_cases);
  if (!arguments.peers.empty())
    sections.push_back(compare_peers(or_all(arguments.peers, peer_names()), evaluations.back(),
                                     taught.taught(), method));
}

// What the library refuses in an argument is wrong usage.
template <class Read>
auto read_argument(const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    wrong_usage(error.what());
  }
}

void run(const EvaluateArguments& arguments, CommandContext& context) {
  Method method = read_argument(
      [&] { return make_method(arguments.preset, read_settings(arguments.settings)); });
  method.jobs = arguments.jobs;
  method.progress = show_progress();
  const auto requirements = read_argument([&] { return parse_requirements(arguments.require); });
  if (thread_count(arguments.jobs) > 1) cv::setNumThreads(1);
  Dataset negatives;
  if (!arguments.negatives.empty()) negatives = load_dataset(arguments.negatives);

  std::vector<Evaluation> evaluations;
  std::vector<ReportSection> sections;
  for (const auto& path : expand_datasets(arguments.datasets, arguments.negatives))
    work_on(select_tests(load_dataset(path), arguments.groups, arguments.limit), negatives,
            arguments, method, evaluations, sections);

  print(evaluations, sections, arguments.json);
  if (!arguments.report.empty()) {
    const auto page = write_report(make_report(evaluations, sections), arguments.report);
    std::cerr << "report: " << page.string() << '\n';
  }
  if (!arguments.markdown.empty())
    write_file(arguments.markdown, make_markdown(evaluations, sections));
  if (!arguments.dump.empty()) {
    std::string lines;
    for (const Evaluation& evaluation : evaluations) lines += to_json_lines(evaluation);
    write_file(arguments.dump, lines);
  }
  for (const Evaluation& evaluation : evaluations)
    report_problems(evaluation, requirements, context);
}

CLI::Option* add_names(CLI::App& command, const std::string& name, std::vector<std::string>& names,
                       std::vector<std::string> allowed, const std::string& help) {
  allowed.emplace_back("all");
  return command.add_option(name, names, help)->check(CLI::IsMember(allowed))->delimiter(',');
}

void add_outputs(CLI::App& command, EvaluateArguments& a) {
  command.add_option("--report", a.report, "Write FOLDER/index.html: plots, pictures, worst cases")
      ->type_name("FOLDER");
  command.add_option("--markdown", a.markdown, "Write the tables to FILE")->type_name("FILE");
  command
      .add_option("--dump", a.dump,
                  "Write every detection and every miss to FILE, a line of JSON each")
      ->type_name("FILE");
  command.add_flag("--json", a.json, "One line of JSON for each data set");
  command.add_option("--require", a.require,
                     "Fail unless met, e.g. recall=0.95,precision=0.99,false_positives=0");
}

}  // namespace

void add_evaluate(CLI::App& app, CommandContext& context) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = add_command(
      app, "evaluate", "Teach a data set's objects, recognise its tests and print how good it was",
      "  posevote evaluate data/demo --report report\n"
      "  posevote evaluate my-sets --negatives my-negatives\n"
      "  posevote evaluate data/demo --groups 'occluded*' --compare opencv-sift,opencv-orb\n"
      "  posevote evaluate data/demo --sweep blur,noise\n"
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
  add_names(*command, "--compare", a.peers, peer_names(), "Run the usual OpenCV scripts as well");
  add_names(*command, "--table", a.tables, paper_result_names(),
            "The paper's evaluation beside its own numbers; all: what the data set can give");
  add_names(*command, "--sweep", a.sweeps, sweep_names(),
            "Disturb the pictures more and more and see when it fails");
  add_outputs(*command, a);
  command->callback([arguments, &context] { run(*arguments, context); });
}

}  // namespace posevote::cli
