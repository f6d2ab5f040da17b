#include "posevote/evaluate/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

double share(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : std::nan("");
}

TimeSummary summarize_times(const std::vector<StageTimes>& times, double StageTimes::*stage) {
  std::vector<double> values;
  values.reserve(times.size());
  for (const StageTimes& time : times) values.push_back(time.*stage);
  return {median(values), quantile(values, 0.95)};
}

}  // namespace

double Summary::recall() const {
  return share(right, asked);
}
Interval Summary::recall_interval() const {
  return wilson_interval(right, asked);
}
double Summary::precision() const {
  return share(right, right + false_positives);
}
double Summary::false_positives_per_image() const {
  return share(false_positives, images);
}

Summary summarize(const std::string& name, const Dataset& dataset,
                  const std::vector<TestOutcome>& outcomes,
                  const std::function<bool(const DatasetTest&)>& wanted) {
  Summary summary;
  summary.name = name;
  std::vector<StageTimes> times;
  for (const TestOutcome& outcome : outcomes) {
    if (wanted && !wanted(dataset.tests[outcome.test])) continue;
    ++summary.images;
    summary.asked += outcome.score.asked;
    summary.right += outcome.score.right;
    summary.false_positives += outcome.score.false_positives;
    summary.twins += outcome.score.twins;
    summary.ignored += outcome.score.ignored;
    if (outcome.error.empty())
      times.push_back(outcome.result.time_ms);
    else
      ++summary.unreadable;
  }
  summary.detect = summarize_times(times, &StageTimes::detect);
  summary.match = summarize_times(times, &StageTimes::match);
  summary.vote = summarize_times(times, &StageTimes::vote);
  summary.verify = summarize_times(times, &StageTimes::verify);
  summary.total = summarize_times(times, &StageTimes::total);
  return summary;
}

std::vector<Summary> summarize_groups(const Dataset& dataset,
                                      const std::vector<TestOutcome>& outcomes) {
  std::vector<Summary> summaries;
  for (const std::string& group : dataset.groups())
    summaries.push_back(summarize(group, dataset, outcomes,
                                  [&](const DatasetTest& test) { return test.group == group; }));
  return summaries;
}

const std::vector<Ranking>& rankings() {
  static const std::vector<Ranking> all{
      {"probability", [](const Detection& d) { return d.probability; }},
      {"significance", [](const Detection& d) { return -d.log10_false_alarms; }},
      {"confidence", [](const Detection& d) { return d.confidence; }},
      {"inliers", [](const Detection& d) { return static_cast<double>(d.inliers); }}};
  return all;
}

const Ranking& ranking(const std::string& name) {
  const auto found = std::ranges::find(rankings(), name, &Ranking::name);
  if (found == rankings().end())
    throw Error(ErrorCode::invalid_argument, "there is no ranking '" + name + "'");
  return *found;
}

std::vector<RankedDetection> rank_detections(const std::vector<TestOutcome>& outcomes,
                                             const Ranking& ranking) {
  std::vector<RankedDetection> ranked;
  for (const TestOutcome& outcome : outcomes)
    for (std::size_t i = 0; i < outcome.score.judgements.size(); ++i) {
      const Verdict verdict = outcome.score.judgements[i].verdict;
      if (verdict == Verdict::right || verdict == Verdict::false_positive)
        ranked.push_back({ranking.value(outcome.result.detections[i]), verdict == Verdict::right});
    }
  return ranked;
}

std::vector<RankedDetection> rank_with_negatives(const Evaluation& evaluation,
                                                 const Ranking& ranking) {
  auto ranked = rank_detections(evaluation.outcomes, ranking);
  for (const RankedDetection& detection : rank_detections(evaluation.negative_outcomes, ranking))
    if (!detection.right) ranked.push_back(detection);
  return ranked;
}

std::vector<CurvePoint> make_curve(std::vector<RankedDetection> detections) {
  std::ranges::sort(detections, std::greater{}, &RankedDetection::value);
  std::vector<CurvePoint> curve;
  CurvePoint point;
  for (const RankedDetection& detection : detections) {
    ++(detection.right ? point.right : point.false_positives);
    point.threshold = detection.value;
    if (!curve.empty() && curve.back().threshold == point.threshold)
      curve.back() = point;
    else
      curve.push_back(point);
  }
  return curve;
}

double recall_without_false_positives(const std::vector<RankedDetection>& detections, int asked) {
  double highest_false = -std::numeric_limits<double>::infinity();
  for (const RankedDetection& detection : detections)
    if (!detection.right) highest_false = std::max(highest_false, detection.value);
  const auto above = std::ranges::count_if(detections, [&](const RankedDetection& detection) {
    return detection.right && detection.value > highest_false;
  });
  return share(static_cast<int>(above), asked);
}

}  // namespace posevote
