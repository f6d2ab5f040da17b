#include "posevote/evaluate/evaluator.hpp"

#include <chrono>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "posevote/core/error.hpp"
#include "posevote/image/read_image.hpp"

namespace posevote {
namespace {

struct Job {
  std::size_t object, view;
};

cv::Mat read_reduced(const Dataset& dataset, const std::filesystem::path& relative, double factor) {
  cv::Mat picture;
  if (relative.empty()) return picture;
  picture = read_dataset_image(dataset, relative);
  if (factor < 1) cv::resize(picture, picture, cv::Size(), factor, factor, cv::INTER_AREA);
  return picture;
}

ViewSource read_source(const Dataset& dataset, const DatasetView& view, double factor) {
  const auto read = [&](const std::filesystem::path& relative) {
    return read_reduced(dataset, relative, factor);
  };
  ViewSource source;
  source.picture = read(view.image);
  source.background = read(view.background);
  source.mask = read(view.mask);
  source.yaw_deg = view.yaw_deg;
  return source;
}

struct TaughtView {
  std::shared_ptr<const View> view;  // none: refused
  std::string refused_because;
  std::optional<SilhouetteCase> silhouette;
};

// Without a view: that of a view that was refused.
SilhouetteCase check_silhouette(const View* view, const ViewSource& source, const cv::Mat& truth) {
  SilhouetteCase result;
  result.refused = view == nullptr;
  if (view != nullptr) result.outline = view->outline;
  result.fit = compare_silhouettes(view != nullptr ? view->mask : cv::Mat(), to_grey(truth),
                                   source.picture, source.background);
  return result;
}

TaughtView teach_one(const Dataset& dataset, const DatasetObject& object, std::size_t number,
                     const TeachOptions& options, double factor) {
  const DatasetView& wanted = object.views[number];
  const ViewSource source = read_source(dataset, wanted, factor);
  TaughtView taught;
  try {
    View view = teach_view(source, options);
    view.id = wanted.image.generic_string();
    taught.view = std::make_shared<const View>(std::move(view));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::unusable_view) throw;
    taught.refused_because = error.what();
  }
  if (wanted.truth_mask.empty() || wanted.background.empty()) return taught;
  taught.silhouette =
      check_silhouette(taught.view.get(), source, read_reduced(dataset, wanted.truth_mask, factor));
  taught.silhouette->object = object.name;
  taught.silhouette->image = wanted.image.generic_string();
  taught.silhouette->truth_mask = wanted.truth_mask.generic_string();
  return taught;
}

TestOutcome run_test(const Dataset& dataset, std::size_t test, const RecognizeFunction& recognize) {
  TestOutcome outcome;
  outcome.test = test;
  try {
    outcome.result = recognize(read_dataset_image(dataset, dataset.tests[test].image));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::unreadable_image) throw;
    outcome.error = error.what();
  }
  outcome.score = score_detections(outcome.result, dataset.tests[test], dataset);
  return outcome;
}

}  // namespace

cv::Mat read_dataset_image(const Dataset& dataset, const std::filesystem::path& relative) {
  ReadOptions as_stored;
  as_stored.apply_exif = false;
  return read_image(dataset.path(relative).string(), as_stored);
}

Score score_detections(const RecognitionResult& result, const DatasetTest& test,
                       const Dataset& dataset) {
  std::vector<Claim> claims;
  for (const Detection& detection : result.detections)
    claims.push_back({detection.object, detection.box, detection.confidence});
  return score_claims(claims, test, dataset, result.image_size);
}

TaughtDataset teach_dataset(const Dataset& dataset, const TeachOptions& options, int jobs,
                            const Progress& progress, double factor) {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Job> work;
  for (std::size_t object = 0; object < dataset.objects.size(); ++object)
    for (std::size_t view = 0; view < dataset.objects[object].views.size(); ++view)
      work.push_back({object, view});

  std::vector<TaughtView> views(work.size());
  parallel_for(
      work.size(), jobs,
      [&](std::size_t i) {
        views[i] =
            teach_one(dataset, dataset.objects[work[i].object], work[i].view, options, factor);
      },
      progress);

  TaughtDataset taught;
  std::vector<ObjectModel> objects;
  for (const DatasetObject& object : dataset.objects) objects.push_back({object.name, {}});
  for (std::size_t i = 0; i < work.size(); ++i) {
    const DatasetObject& object = dataset.objects[work[i].object];
    if (views[i].view)
      objects[work[i].object].views.push_back(views[i].view);
    else
      taught.refused.push_back({object.name, object.views[work[i].view].image.generic_string(),
                                views[i].refused_because});
    if (views[i].silhouette) taught.silhouettes.push_back(*std::move(views[i].silhouette));
  }
  std::erase_if(objects, [](const ObjectModel& object) { return object.views.empty(); });
  taught.models = std::make_shared<const ModelSet>(options.feature.signature(), std::move(objects));
  taught.time_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return taught;
}

std::vector<TestOutcome> run_tests(const Dataset& dataset, const RecognizeFunction& recognize,
                                   int jobs, const Progress& progress) {
  std::vector<TestOutcome> outcomes(dataset.tests.size());
  parallel_for(
      outcomes.size(), jobs, [&](std::size_t i) { outcomes[i] = run_test(dataset, i, recognize); },
      progress);
  return outcomes;
}

Evaluation make_evaluation(const Dataset& dataset, const TaughtDataset& taught,
                           std::vector<TestOutcome> outcomes, int jobs) {
  Evaluation evaluation;
  evaluation.dataset = dataset;
  evaluation.objects = taught.models->objects().size();
  evaluation.views = taught.models->views().size();
  evaluation.features = taught.models->feature_count();
  evaluation.refused = taught.refused;
  evaluation.silhouettes = taught.silhouettes;
  evaluation.teach_ms = taught.time_ms;
  evaluation.jobs = thread_count(jobs);
  evaluation.outcomes = std::move(outcomes);
  return evaluation;
}

}  // namespace posevote
