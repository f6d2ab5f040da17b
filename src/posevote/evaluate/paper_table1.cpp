// Table I and section C: where the time goes.
#include <algorithm>
#include <cmath>

#include "posevote/evaluate/paper_parts.hpp"
#include "posevote/evaluate/summary.hpp"

namespace posevote {
namespace {

// A view of an object and the test that shows it in nearly that pose.
struct Pair {
  std::size_t object, view, test;
  double turn_deg;
};

double turn_between(double a, double b) {
  return std::abs(std::remainder(a - b, 360.0));
}

// The test nearest in pose to a taught view, for every object that is alone in some picture.
std::vector<Pair> nearest_pairs(const Dataset& dataset) {
  std::vector<Pair> pairs;
  for (std::size_t object = 0; object < dataset.objects.size(); ++object) {
    Pair best{object, 0, 0, 1e9};
    const auto& views = dataset.objects[object].views;
    for (std::size_t test = 0; test < dataset.tests.size(); ++test) {
      const auto& listed = dataset.tests[test].objects;
      if (listed.size() != 1 || listed[0].name != dataset.objects[object].name) continue;
      for (std::size_t view = 0; view < views.size(); ++view) {
        const double turn = turn_between(listed[0].yaw_deg, views[view].yaw_deg);
        const double known = std::isnan(turn) ? 180 : turn;
        if (known < best.turn_deg) best = {object, view, test, known};
      }
    }
    if (best.turn_deg < 1e9) pairs.push_back(best);
  }
  return pairs;
}

std::string middle(const std::vector<TestOutcome>& outcomes,
                   const std::function<double(const RecognitionResult&)>& value, int decimals) {
  std::vector<double> values;
  values.reserve(outcomes.size());
  for (const TestOutcome& outcome : outcomes) values.push_back(value(outcome.result));
  return fixed(median(values), decimals);
}

}  // namespace

ReportSection paper_table1(const Dataset& dataset, const Method& method) {
  Dataset source = with_groups(dataset, "*weak*");
  if (source.tests.empty()) source = dataset;
  const auto pairs = nearest_pairs(source);
  if (pairs.empty()) refuse(dataset, "table1", "picture that shows one object alone");

  Method alone = method;
  alone.jobs = 1;
  alone.progress = {};
  std::vector<TestOutcome> outcomes;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    Dataset one = source;
    one.objects = {{source.objects[pairs[i].object].name,
                    {source.objects[pairs[i].object].views[pairs[i].view]}}};
    one.tests = {source.tests[pairs[i].test]};
    const TaughtMethod taught(one, alone);
    static_cast<void>(taught.run(one));  // the first run warms caches up
    outcomes.push_back(taught.run(one).front());
    if (method.progress) method.progress("table 1", i + 1, pairs.size());
  }
  const auto count = [&](int StageCounts::*stage) {
    return middle(
        outcomes, [&](auto& r) { return double(r.counts.*stage); }, 0);
  };
  const auto time = [&](double StageTimes::*stage) {
    return middle(
        outcomes, [&](auto& r) { return r.time_ms.*stage; }, 1);
  };
  int right = 0;
  for (const TestOutcome& outcome : outcomes) right += outcome.score.right;

  Table table;
  table.title = "Table I: time of each step";
  table.header = {"step", "key points, paper", "ours", "ms, paper", "ours"};
  table.rows = {
      {"detection", "500", count(&StageCounts::features), "697", time(&StageTimes::detect)},
      {"matching", "139", count(&StageCounts::matched), "61", time(&StageTimes::match)},
      {"Hough clustering", "102", count(&StageCounts::clustered), "13", time(&StageTimes::vote)},
      {"homography", "98", count(&StageCounts::verified), "12", time(&StageTimes::verify)},
      {"total", "", "", "783", time(&StageTimes::total)}};
  table.note = "Ours: medians over " + std::to_string(pairs.size()) +
               " objects, each taught from one view and looked for in the picture that shows it "
               "alone and nearest to that pose, one picture at a time; " +
               std::to_string(right) + " recognised. Paper: one object, 2 GHz Core 2.";
  return {"Paper, table I: performance", "", {table}, {}};
}

ReportSection paper_accumulator(const Dataset& dataset, const Method& method) {
  Method changed = method;
  const OptionList options = list_options(changed.recognize);
  options.set("vote.grid", "image");
  const TaughtMethod first(dataset, changed);
  Table table;
  table.title = "Section C: accumulator size";
  table.header = {"bins per dimension", "asked",   "right", "recall", "false", "vote ms",
                  "vote+verify ms",     "total ms"};
  ChartSeries recall{"recall", {}};
  for (const int bins : {4, 6, 8, 10, 12, 15, 20, 30}) {
    for (const char* dimension : {"x", "y", "scale", "rotation"})
      options.set("vote.bins_" + std::string(dimension), std::to_string(bins));
    const auto outcomes = TaughtMethod(first.taught(), changed).run(dataset);
    const Summary s = summarize("", dataset, outcomes);
    std::vector<double> both;
    both.reserve(outcomes.size());
    for (const TestOutcome& outcome : outcomes)
      both.push_back(outcome.result.time_ms.vote + outcome.result.time_ms.verify);
    table.rows.push_back({std::to_string(bins), std::to_string(s.asked), std::to_string(s.right),
                          percent(s.recall()), std::to_string(s.false_positives),
                          fixed(s.vote.median_ms, 2), fixed(median(both), 2),
                          fixed(s.total.median_ms, 1)});
    recall.points.push_back({double(bins), s.recall()});
  }
  table.note =
      "Paper: 10 bins are a good trade-off; more are faster but match less and become unreliable, "
      "fewer are too inaccurate (no numbers given). Positions are binned across the picture here, "
      "as in the paper.";
  return {"Paper, section C: accumulator size",
          "",
          {table},
          {{"Recall over bins per dimension", {"bins", 0, 30}, {"recall", 0, 1}, {recall}}}};
}

}  // namespace posevote
