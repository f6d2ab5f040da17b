#include "posevote/evaluate/results.hpp"

#include <algorithm>
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

std::string jobs_note(int jobs) {
  if (jobs < 2) return "";
  return std::to_string(jobs) +
         " pictures were recognised at a time, which makes each slower; --jobs 1 measures the time "
         "of one alone.";
}

void add_counts(Summary& sum, const Summary& more) {
  sum.images += more.images;
  sum.asked += more.asked;
  sum.right += more.right;
  sum.false_positives += more.false_positives;
  sum.twins += more.twins;
}

// Without what cannot be summed over sets: objects, views, recall at zero, times.
std::vector<std::string> set_row(const Summary& s, const Summary& negative) {
  return {s.name,
          "",
          "",
          std::to_string(s.images),
          std::to_string(s.asked),
          std::to_string(s.right),
          percent(s.recall()),
          s.asked > 0 ? interval_text(s.recall_interval()) : "-",
          std::to_string(s.false_positives),
          std::to_string(s.twins),
          negative.images > 0
              ? std::to_string(negative.false_positives) + " / " + std::to_string(negative.images)
              : "-",
          "",
          "",
          ""};
}

ordered_json silhouettes_json(const std::vector<SilhouetteCase>& cases) {
  ordered_json list = ordered_json::array();
  for (const SilhouetteCase& one : cases)
    list.push_back({{"object", one.object},
                    {"image", one.image},
                    {"iou", rounded(one.fit.iou, 10000)},
                    {"wrong_share", rounded(one.fit.wrong_share, 10000)},
                    {"shadow_share", rounded(one.fit.shadow_share, 10000)}});
  return list;
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
  table.note = jobs_note(evaluation.jobs);
  return table;
}

Table set_table(const std::vector<Evaluation>& evaluations) {
  Table table;
  table.header = {"data set", "objects", "views", "pictures",   "asked", "right", "recall",
                  "95 %",     "false",   "twins", "neg. false", "R@0",   "ms",    "p95"};
  Summary all;
  Summary all_negative;
  for (const Evaluation& evaluation : evaluations) {
    const Summary s = summarize(evaluation.dataset.name, evaluation.dataset, evaluation.outcomes);
    const Summary negative = summarize("", evaluation.negatives, evaluation.negative_outcomes);
    add_counts(all, s);
    add_counts(all_negative, negative);
    auto row = set_row(s, negative);
    row[1] = std::to_string(evaluation.objects);
    row[2] = std::to_string(evaluation.views);
    if (!evaluation.refused.empty())
      row[2] += " (" + std::to_string(evaluation.refused.size()) + " refused)";
    row[11] = percent(recall_at_zero(evaluation, ranking("probability")));
    row[12] = fixed(s.total.median_ms, 0);
    row[13] = fixed(s.total.p95_ms, 0);
    table.rows.push_back(std::move(row));
  }
  all.name = "all";
  if (evaluations.size() > 1) table.rows.push_back(set_row(all, all_negative));
  table.note =
      "95 %: Wilson's interval of the recall. neg. false: false answers on how many pictures "
      "without any of the objects. R@0: recall at the probability, chosen afterwards, that lets no "
      "false answer through on the set and those pictures together. ms: median and 95th percentile "
      "per picture.";
  return table;
}

Table set_time_table(const std::vector<Evaluation>& evaluations) {
  Table table;
  table.header = {"median ms", "detect", "match", "vote", "verify", "total"};
  int jobs = 1;
  for (const Evaluation& evaluation : evaluations) {
    const Summary s = summarize(evaluation.dataset.name, evaluation.dataset, evaluation.outcomes);
    table.rows.push_back({s.name, fixed(s.detect.median_ms, 1), fixed(s.match.median_ms, 1),
                          fixed(s.vote.median_ms, 1), fixed(s.verify.median_ms, 1),
                          fixed(s.total.median_ms, 1)});
    jobs = std::max(jobs, evaluation.jobs);
  }
  table.note = jobs_note(jobs);
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
  if (!evaluation.silhouettes.empty())
    document["silhouettes"] = silhouettes_json(evaluation.silhouettes);
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
