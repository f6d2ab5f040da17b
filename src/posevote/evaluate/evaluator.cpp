#include "posevote/evaluate/evaluator.hpp"

#include <chrono>
#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"
#include "posevote/image/read_image.hpp"

namespace posevote {
namespace {

struct Job {
  std::size_t object, view;
};

ViewSource read_source(const Dataset& dataset, const DatasetView& view, double factor) {
  const auto read = [&](const std::filesystem::path& relative) {
    cv::Mat picture;
    if (relative.empty()) return picture;
    picture = read_dataset_image(dataset, relative);
    if (factor < 1) cv::resize(picture, picture, cv::Size(), factor, factor, cv::INTER_AREA);
    return picture;
  };
  ViewSource source;
  source.picture = read(view.image);
  source.background = read(view.background);
  source.mask = read(view.mask);
  source.yaw_deg = view.yaw_deg;
  return source;
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

  std::vector<std::shared_ptr<const View>> views(work.size());
  std::vector<std::string> reasons(work.size());
  const auto teach = [&](std::size_t i) {
    const DatasetView& wanted = dataset.objects[work[i].object].views[work[i].view];
    try {
      View view = teach_view(read_source(dataset, wanted, factor), options);
      view.id = wanted.image.generic_string();
      views[i] = std::make_shared<const View>(std::move(view));
    } catch (const Error& error) {
      if (error.code() != ErrorCode::unusable_view) throw;
      reasons[i] = error.what();
    }
  };
  parallel_for(work.size(), jobs, teach, progress);

  TaughtDataset taught;
  std::vector<ObjectModel> objects;
  for (const DatasetObject& object : dataset.objects) objects.push_back({object.name, {}});
  for (std::size_t i = 0; i < work.size(); ++i) {
    const DatasetObject& object = dataset.objects[work[i].object];
    if (views[i])
      objects[work[i].object].views.push_back(views[i]);
    else
      taught.refused.push_back(
          {object.name, object.views[work[i].view].image.generic_string(), reasons[i]});
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
  evaluation.teach_ms = taught.time_ms;
  evaluation.jobs = thread_count(jobs);
  evaluation.outcomes = std::move(outcomes);
  return evaluation;
}

}  // namespace posevote
