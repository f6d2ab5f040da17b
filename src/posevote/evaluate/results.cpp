#include "posevote/evaluate/results.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace posevote {
namespace {

using nlohmann::ordered_json;

std::string interval_text(const Interval& interval) {
  return fixed(100 * interval.low, 1) + ".." + fixed(100 * interval.high, 1);
}

std::vector<Summary> groups_and_whole(const Evaluation& evaluation) {
  auto summaries = summarize_groups(evaluation.dataset, evaluation.outcomes);
  for (Summary& summary : summaries)
    if (summary.name.empty()) summary.name = "(no group)";
  summaries.push_back(summarize("all", evaluation.dataset, evaluation.outcomes));
  return summaries;
}

double recall_at_zero(const Evaluation& evaluation, const Ranking& ranking) {
  const int asked = summarize("", evaluation.dataset, evaluation.outcomes).asked;
  return recall_without_false_positives(rank_with_negatives(evaluation, ranking), asked);
}

// JSON has no NaN.
ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json rounded(double value, double steps) {
  return number(std::round(value * steps) / steps);
}

ordered_json box_json(const cv::Rect2d& box) {
  return {rounded(box.x, 100), rounded(box.y, 100), rounded(box.width, 100),
          rounded(box.height, 100)};
}

ordered_json time_json(const TimeSummary& time) {
  return {{"median", rounded(time.median_ms, 1000)}, {"p95", rounded(time.p95_ms, 1000)}};
}

ordered_json summary_json(const Summary& summary) {
  const Interval interval = summary.recall_interval();
  return {{"group", summary.name},
          {"images", summary.images},
          {"unreadable", summary.unreadable},
          {"asked", summary.asked},
          {"right", summary.right},
          {"recall", number(summary.recall())},
          {"recall_interval", {interval.low, interval.high}},
          {"false_positives", summary.false_positives},
          {"false_positives_per_image", number(summary.false_positives_per_image())},
          {"precision", number(summary.precision())},
          {"twins", summary.twins},
          {"ignored", summary.ignored},
          {"time_ms",
           {{"detect", time_json(summary.detect)},
            {"match", time_json(summary.match)},
            {"vote", time_json(summary.vote)},
            {"verify", time_json(summary.verify)},
            {"total", time_json(summary.total)}}}};
}

ordered_json measured_json(const PresenceEvidence& measured) {
  const Agreement& agreement = measured.agreement;
  return {{"digits", number(measured.digits)},
          {"confidence", number(measured.confidence)},
          {"coverage", number(measured.coverage)},
          {"distortion", number(measured.distortion)},
          {"structure", number(agreement.structure)},
          {"structure_near_matches", number(agreement.structure_near_matches)},
          {"colour_difference", number(agreement.colour_difference)},
          {"rim", number(agreement.rim)},
          {"found", number(measured.found)},
          {"consensus", number(measured.consensus)},
          {"visible", number(agreement.visible)}};
}

ordered_json detection_json(const Dataset& dataset, const TestOutcome& outcome, std::size_t i) {
  const DatasetTest& test = dataset.tests[outcome.test];
  const Detection& detection = outcome.result.detections[i];
  const Judgement& judgement = outcome.score.judgements[i];
  ordered_json line{{"set", dataset.name},
                    {"image", test.image.generic_string()},
                    {"group", test.group},
                    {"verdict", to_string(judgement.verdict)},
                    {"object", detection.object},
                    {"view", detection.view},
                    {"confidence", number(detection.confidence)},
                    {"probability", number(detection.probability)},
                    {"log10_false_alarms", number(detection.log10_false_alarms)},
                    {"inliers", detection.inliers},
                    {"features_in_area", detection.features_in_area},
                    {"box", box_json(detection.box)},
                    {"iou", rounded(judgement.iou, 1000)},
                    {"measured", measured_json(detection.measured)}};
  if (!detection.alternatives.empty()) line["alternatives"] = detection.alternatives;
  if (judgement.truth >= 0) {
    const TruthObject& truth = test.objects[static_cast<std::size_t>(judgement.truth)];
    line["truth"] = truth.name;
    line["truth_box"] = box_json(truth.box);
    line["visible"] = truth.visible;
    line["yaw"] = number(truth.yaw_deg);
  }
  return line;
}

ordered_json missed_json(const Dataset& dataset, const TestOutcome& outcome, int missed) {
  const DatasetTest& test = dataset.tests[outcome.test];
  const TruthObject& truth = test.objects[static_cast<std::size_t>(missed)];
  ordered_json line{{"set", dataset.name},      {"image", test.image.generic_string()},
                    {"group", test.group},      {"verdict", "missed"},
                    {"truth", truth.name},      {"truth_box", box_json(truth.box)},
                    {"visible", truth.visible}, {"yaw", number(truth.yaw_deg)}};
  if (!outcome.error.empty()) line["error"] = outcome.error;
  return line;
}

std::string lines_of(const Dataset& dataset, const std::vector<TestOutcome>& outcomes) {
  std::string text;
  for (const TestOutcome& outcome : outcomes) {
    for (std::size_t i = 0; i < outcome.result.detections.size(); ++i)
      text += detection_json(dataset, outcome, i).dump() + "\n";
    for (const int missed : outcome.score.missed)
      text += missed_json(dataset, outcome, missed).dump() + "\n";
  }
  return text;
}

}  // namespace

Table group_table(const Evaluation& evaluation) {
  Table table;
  table.header = {"group", "images",   "asked", "right",     "recall", "95 %",
                  "false", "false/im", "twins", "precision", "ms",     "p95"};
  for (const Summary& s : groups_and_whole(evaluation))
    table.rows.push_back(
        {s.name, std::to_string(s.images), std::to_string(s.asked), std::to_string(s.right),
         percent(s.recall()), s.asked > 0 ? interval_text(s.recall_interval()) : "-",
         std::to_string(s.false_positives), fixed(s.false_positives_per_image(), 3),
         std::to_string(s.twins), percent(s.precision()), fixed(s.total.median_ms, 0),
         fixed(s.total.p95_ms, 0)});
  return table;
}

Table time_table(const Evaluation& evaluation) {
  Table table;
  table.header = {"median / p95 [ms]", "detect", "match", "vote", "verify", "total"};
  const auto text = [](const TimeSummary& time) {
    return fixed(time.median_ms, 1) + " / " + fixed(time.p95_ms, 1);
  };
  for (const Summary& s : groups_and_whole(evaluation))
    table.rows.push_back(
        {s.name, text(s.detect), text(s.match), text(s.vote), text(s.verify), text(s.total)});
  if (evaluation.jobs > 1)
    table.note = std::to_string(evaluation.jobs) +
                 " pictures were recognised at a time, which makes each slower; --jobs 1 measures "
                 "the time of one alone.";
  return table;
}

Table set_table(const std::vector<Evaluation>& evaluations) {
  Table table;
  table.header = {"data set",    "objects",    "views",    "refused",  "images", "asked",
                  "right",       "recall",     "95 %",     "false",    "twins",  "precision",
                  "neg. images", "neg. false", "R@0 prob", "R@0 sign", "ms",     "p95"};
  for (const Evaluation& evaluation : evaluations) {
    const Summary s = summarize("all", evaluation.dataset, evaluation.outcomes);
    const Summary negative = summarize("", evaluation.negatives, evaluation.negative_outcomes);
    const bool has_negatives = negative.images > 0;
    table.rows.push_back(
        {evaluation.dataset.name, std::to_string(evaluation.objects),
         std::to_string(evaluation.views), std::to_string(evaluation.refused.size()),
         std::to_string(s.images), std::to_string(s.asked), std::to_string(s.right),
         percent(s.recall()), s.asked > 0 ? interval_text(s.recall_interval()) : "-",
         std::to_string(s.false_positives), std::to_string(s.twins), percent(s.precision()),
         has_negatives ? std::to_string(negative.images) : "-",
         has_negatives ? std::to_string(negative.false_positives) : "-",
         percent(recall_at_zero(evaluation, ranking("probability"))),
         percent(recall_at_zero(evaluation, ranking("significance"))), fixed(s.total.median_ms, 0),
         fixed(s.total.p95_ms, 0)});
  }
  table.note =
      "R@0: recall at the threshold, chosen afterwards, that lets no false positive through on the "
      "set and the negatives together, by probability and by significance.";
  return table;
}

Table ranking_table(const Evaluation& evaluation) {
  Table table;
  table.header = {"ranked by", "recall without a false positive"};
  for (const Ranking& ranking : rankings())
    table.rows.push_back({ranking.name, percent(recall_at_zero(evaluation, ranking))});
  table.note =
      "The threshold is chosen afterwards, on this set" +
      std::string(evaluation.negative_outcomes.empty() ? "." : " and the negatives together.");
  return table;
}

Table refused_table(const Evaluation& evaluation) {
  Table table;
  table.header = {"object", "view", "reason"};
  for (const RefusedView& view : evaluation.refused)
    table.rows.push_back({view.object, view.image, view.reason});
  return table;
}

std::string to_json(const Evaluation& evaluation) {
  ordered_json groups = ordered_json::array();
  for (const Summary& summary : summarize_groups(evaluation.dataset, evaluation.outcomes))
    groups.push_back(summary_json(summary));
  ordered_json refused = ordered_json::array();
  for (const RefusedView& view : evaluation.refused)
    refused.push_back({{"object", view.object}, {"image", view.image}, {"reason", view.reason}});
  ordered_json zero;
  for (const Ranking& ranking : rankings())
    zero[ranking.name] = number(recall_at_zero(evaluation, ranking));
  ordered_json document{
      {"dataset", evaluation.dataset.name},
      {"objects", evaluation.objects},
      {"views", evaluation.views},
      {"features", evaluation.features},
      {"refused_views", refused},
      {"teach_ms", rounded(evaluation.teach_ms, 10)},
      {"jobs", evaluation.jobs},
      {"all", summary_json(summarize("all", evaluation.dataset, evaluation.outcomes))},
      {"groups", groups},
      {"recall_without_false_positives", zero}};
  if (!evaluation.negative_outcomes.empty())
    document["negatives"] = summary_json(
        summarize(evaluation.negatives.name, evaluation.negatives, evaluation.negative_outcomes));
  return document.dump();
}

std::string to_json_lines(const Evaluation& evaluation) {
  return lines_of(evaluation.dataset, evaluation.outcomes) +
         lines_of(evaluation.negatives, evaluation.negative_outcomes);
}

}  // namespace posevote
