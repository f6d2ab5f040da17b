// How objects are taught and recognised in an evaluation.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "posevote/evaluate/evaluator.hpp"

namespace posevote {

/// Told about the progress of a named task; never by two threads at once.
using TaskProgress =
    std::function<void(const std::string& task, std::size_t done, std::size_t total)>;

struct Method {
  RecognizeOptions recognize;
  TeachOptions teach;
  int jobs = 0;  ///< pictures at a time; 0: one for each core
  TaskProgress progress;
};

/// A preset with changes, e.g. {"verify.min_inliers", "5"}. Names that begin with "teach." are the
/// teacher's; both use the same features unless "teach.feature.*" says otherwise.
/// Throws Error{invalid_argument}.
[[nodiscard]] Method make_method(const std::string& preset,
                                 const std::vector<std::pair<std::string, std::string>>& settings);

/// The objects of a dataset, taught, and ready to be looked for.
class TaughtMethod {
 public:
  TaughtMethod(const Dataset& dataset, const Method& method);
  /// The same with objects that are taught already.
  TaughtMethod(TaughtDataset taught, const Method& method);

  /// Recognises and scores the tests of `tests`, which may be another dataset's.
  [[nodiscard]] std::vector<TestOutcome> run(const Dataset& tests) const;
  [[nodiscard]] Evaluation evaluate(const Dataset& dataset, const Dataset& negatives = {}) const;

  /// Adds to an evaluation by this method why its worst cases came out as they did: `max_cases` of
  /// each list of `worst_cases`. Each of their pictures is recognised once more.
  void explain_worst(Evaluation& evaluation, std::size_t max_cases) const;

  [[nodiscard]] const Recognizer& recognizer() const { return recognizer_; }
  [[nodiscard]] const TaughtDataset& taught() const { return taught_; }

 private:
  Method method_;
  TaughtDataset taught_;
  Recognizer recognizer_;
};

/// `progress` of one task, for `parallel_for`.
[[nodiscard]] Progress task(const TaskProgress& progress, const std::string& name);

}  // namespace posevote
