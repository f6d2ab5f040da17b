// Teaches a dataset's objects, recognises its tests and scores what was found.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "posevote/evaluate/dataset.hpp"
#include "posevote/evaluate/parallel.hpp"
#include "posevote/evaluate/scorer.hpp"
#include "posevote/evaluate/silhouette.hpp"
#include "posevote/model/model_set.hpp"
#include "posevote/recognize/explain.hpp"
#include "posevote/recognize/recognizer.hpp"
#include "posevote/teach/teacher.hpp"

namespace posevote {

/// A view that could not be taught, and why.
struct RefusedView {
  std::string object;
  std::string image;
  std::string reason;
};

struct TaughtDataset {
  std::shared_ptr<const ModelSet> models;  ///< view ids are the pictures' paths in the dataset
  std::vector<RefusedView> refused;
  std::vector<SilhouetteCase> silhouettes;  ///< of the views whose true silhouette is known
  double time_ms = 0;                       ///< of the whole teaching, wall clock
};

/// What came out of one test picture.
struct TestOutcome {
  std::size_t test = 0;  ///< index into Dataset::tests
  std::string error;     ///< why the picture could not be read; then everything in it is missed
  RecognitionResult result;
  Score score;  ///< judgements in the order of result.detections
};

struct Evaluation {
  Dataset dataset;
  std::size_t objects = 0, views = 0, features = 0;  ///< taught
  std::vector<RefusedView> refused;
  std::vector<SilhouetteCase> silhouettes;
  double teach_ms = 0;
  int jobs = 1;  ///< pictures recognised at a time; more than one makes each of them slower
  std::vector<TestOutcome> outcomes;  ///< one for each test, in their order
  /// Pictures with none of the objects in them, recognised against the same objects; may be empty.
  Dataset negatives;
  std::vector<TestOutcome> negative_outcomes;
  /// Why an object was found in a picture, or why not; by the picture's path and the object. Only
  /// of what `explain_worst` was asked for.
  std::map<std::pair<std::filesystem::path, std::string>, Explanation> explanations;
};

/// Anything that finds objects in a picture; must be safe to call from many threads.
using RecognizeFunction = std::function<RecognitionResult(const cv::Mat&)>;

/// Reads a picture of a dataset: pixels as stored. Throws Error{unreadable_image}.
[[nodiscard]] cv::Mat read_dataset_image(const Dataset& dataset,
                                         const std::filesystem::path& relative);

/// Teaches every view on `jobs` threads. A view whose picture is unusable is listed in `refused`;
/// an object without any view left is not taught. Pictures are first scaled by `factor` (at most
/// 1). Throws Error for pictures that cannot be read.
[[nodiscard]] TaughtDataset teach_dataset(const Dataset& dataset, const TeachOptions& options,
                                          int jobs = 0, const Progress& progress = {},
                                          double factor = 1);

/// The score of what was found in the picture of `test`.
[[nodiscard]] Score score_detections(const RecognitionResult& result, const DatasetTest& test,
                                     const Dataset& dataset);

/// Recognises and scores all tests of `dataset` on `jobs` threads. Deterministic but for the times.
[[nodiscard]] std::vector<TestOutcome> run_tests(const Dataset& dataset,
                                                 const RecognizeFunction& recognize, int jobs = 0,
                                                 const Progress& progress = {});

/// Puts the parts together.
[[nodiscard]] Evaluation make_evaluation(const Dataset& dataset, const TaughtDataset& taught,
                                         std::vector<TestOutcome> outcomes, int jobs);

}  // namespace posevote
