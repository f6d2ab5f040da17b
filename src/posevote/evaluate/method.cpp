#include "posevote/evaluate/method.hpp"

namespace posevote {

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

}  // namespace posevote
