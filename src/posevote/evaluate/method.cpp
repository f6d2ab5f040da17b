#include "posevote/evaluate/method.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/cases.hpp"
#include "posevote/recognize/trace.hpp"

namespace posevote {
namespace {

// Of the objects that are taught; none for a picture that cannot be read.
std::vector<Explanation> explain_all(const Recognizer& recognizer,
                                     const std::filesystem::path& picture,
                                     const std::set<std::string>& objects) try {
  const Trace trace = recognizer.trace(read_dataset_image({}, picture));
  std::vector<Explanation> explanations;
  for (const ObjectModel& known : trace.models->objects())
    if (objects.contains(known.name))
      explanations.push_back(explain(trace, recognizer.options(), known.name));
  return explanations;
} catch (const Error& error) {
  if (error.code() != ErrorCode::unreadable_image) throw;
  return {};
}

}  // namespace

Progress task(const TaskProgress& progress, const std::string& name) {
  if (!progress) return {};
  return [progress, name](std::size_t done, std::size_t total) { progress(name, done, total); };
}

Method make_method(const std::string& preset,
                   const std::vector<std::pair<std::string, std::string>>& settings) {
  const std::string prefix = "teach.";
  Method method;
  method.recognize = make_preset(preset);
  const OptionList recognize = list_options(method.recognize);
  for (const auto& [name, value] : settings)
    if (!name.starts_with(prefix)) recognize.set(name, value);
  method.teach.feature = method.recognize.feature;
  if (preset == "paper")  // which keeps the features of a view as they are
    method.teach.only_repeatable = method.teach.foreshortened = false;
  const OptionList teach = list_options(method.teach);
  for (const auto& [name, value] : settings)
    if (name.starts_with(prefix)) teach.set(name.substr(prefix.size()), value);
  return method;
}

TaughtMethod::TaughtMethod(const Dataset& dataset, const Method& method)
    : TaughtMethod(teach_dataset(dataset, method.teach, method.jobs,
                                 task(method.progress, dataset.name + ": teaching")),
                   method) {}

TaughtMethod::TaughtMethod(TaughtDataset taught, const Method& method)
    : method_(method), taught_(std::move(taught)), recognizer_(taught_.models, method.recognize) {}

std::vector<TestOutcome> TaughtMethod::run(const Dataset& tests) const {
  return run_tests(
      tests, [this](const cv::Mat& picture) { return recognizer_.recognize(picture); },
      method_.jobs, task(method_.progress, tests.name + ": recognising"));
}

Evaluation TaughtMethod::evaluate(const Dataset& dataset, const Dataset& negatives) const {
  Evaluation evaluation = make_evaluation(dataset, taught_, run(dataset), method_.jobs);
  evaluation.negatives = negatives;
  evaluation.negative_outcomes = run(negatives);
  return evaluation;
}

void TaughtMethod::explain_worst(Evaluation& evaluation, std::size_t max_cases) const {
  std::map<std::filesystem::path, std::set<std::string>> questions;
  for (const CaseList& list : worst_cases(evaluation))
    for (std::size_t i = 0; i < std::min(max_cases, list.cases.size()); ++i) {
      auto [picture, object] = question_of(list.cases[i]);
      questions[std::move(picture)].insert(std::move(object));
    }
  const std::vector<std::pair<std::filesystem::path, std::set<std::string>>> pictures(
      questions.begin(), questions.end());
  std::vector<std::vector<Explanation>> answers(pictures.size());
  parallel_for(
      pictures.size(), method_.jobs,
      [&](std::size_t i) {
        answers[i] = explain_all(recognizer_, pictures[i].first, pictures[i].second);
      },
      task(method_.progress, evaluation.dataset.name + ": explaining"));
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (Explanation& answer : answers[i])
      evaluation.explanations[{pictures[i].first, answer.object}] = std::move(answer);
}

}  // namespace posevote
