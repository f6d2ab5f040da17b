// Fig. 5: matched features over the object's turn; fig. 8: over its occlusion.
#include <cmath>
#include <map>

#include "posevote/evaluate/paper_parts.hpp"
#include "posevote/evaluate/statistics.hpp"

namespace posevote {
namespace {

struct Cell {
  std::vector<double> inliers, confidence, iou;  // of right detections; inliers: 0 where missed
  int asked = 0, right = 0;
};

using CurveOverValue = std::map<double, Cell>;

void add_outcome(Cell& cell, const DatasetTest& test, const TestOutcome& outcome) {
  for (std::size_t i = 0; i < test.objects.size(); ++i) {
    if (!test.objects[i].asked()) continue;
    ++cell.asked;
    const Detection* detection = right_detection(outcome, static_cast<int>(i));
    cell.inliers.push_back(detection != nullptr ? detection->inliers : 0);
    if (detection == nullptr) continue;
    ++cell.right;
    cell.confidence.push_back(detection->confidence);
    cell.iou.push_back(clipped_iou(detection->box, test.objects[i].box, outcome.result.image_size));
  }
}

double mean(const std::vector<double>& values) {
  if (values.empty()) return std::nan("");
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

CurveOverValue collect(const Dataset& dataset, const std::vector<TestOutcome>& outcomes,
                       double DatasetTest::*field) {
  CurveOverValue curve;
  for (const TestOutcome& outcome : outcomes) {
    const DatasetTest& test = dataset.tests[outcome.test];
    if (!std::isnan(test.*field)) add_outcome(curve[test.*field], test, outcome);
  }
  return curve;
}

// First and last value at which at least half of the most features are matched.
std::string half_range(const CurveOverValue& curve) {
  double most = 0;
  for (const auto& [value, cell] : curve) most = std::max(most, mean(cell.inliers));
  std::string first, last;
  for (const auto& [value, cell] : curve) {
    if (most == 0 || mean(cell.inliers) < most / 2) continue;
    if (first.empty()) first = fixed(value, 1);
    last = fixed(value, 1);
  }
  return first.empty() ? "nowhere" : first + " to " + last;
}

struct Sweep {
  const char* group;
  const char* title;
  const char* unit;
  double DatasetTest::*field;
};

const Sweep sweeps[] = {{"yaw", "turn about the vertical", "deg", &DatasetTest::yaw_deg},
                        {"roll", "turn in the picture", "deg", &DatasetTest::roll_deg},
                        {"scale", "size against the taught view", "", &DatasetTest::scale}};

}  // namespace

ReportSection paper_fig5(const Dataset& dataset, const Method& method) {
  ReportSection section{"Paper, fig. 5: how far may an object be turned?", "", {}, {}};
  const TaughtMethod taught(dataset, method);
  for (const Sweep& sweep : sweeps) {
    const Dataset tests = with_groups(dataset, sweep.group);
    const auto outcomes = taught.run(tests);
    const CurveOverValue curve = collect(tests, outcomes, sweep.field);
    if (curve.empty()) continue;
    Table table;
    table.title = std::string("Matched features over ") + sweep.title;
    table.header = {sweep.group, "asked", "right", "matched features, mean", "confidence, mean"};
    ChartSeries matched{"matched", {}};
    for (const auto& [value, cell] : curve) {
      table.rows.push_back({fixed(value, 2), std::to_string(cell.asked), std::to_string(cell.right),
                            fixed(mean(cell.inliers), 1), percent(mean(cell.confidence))});
      matched.points.push_back({value, mean(cell.inliers)});
    }
    table.note =
        "At least half of the most features: " + half_range(curve) + " " + sweep.unit + " (ours).";
    if (std::string(sweep.group) == "yaw")
      table.note +=
          " Paper, view taught at 180 degrees: the number falls rapidly below 150 and above 220 "
          "degrees.";
    section.tables.push_back(std::move(table));
    section.charts.push_back({std::string("Matched features over ") + sweep.title,
                              {std::string(sweep.group) + (*sweep.unit ? " [deg]" : ""), 0, 0},
                              {"matched features", 0, 0},
                              {matched}});
  }
  if (section.tables.empty()) refuse(dataset, "fig5", "group yaw, roll or scale");
  return section;
}

ReportSection paper_fig8(const Dataset& dataset, const Method& method) {
  const Dataset tests = with_groups(dataset, "occlusion *");
  if (tests.tests.empty()) refuse(dataset, "fig8", "group 'occlusion ...'");
  const auto outcomes = TaughtMethod(dataset, method).run(tests);
  Table table;
  table.title = "Fig. 8: partly hidden objects";
  table.header = {
      "group",        "asked", "right", "recall", "matched features, mean", "confidence, mean",
      "overlap, mean"};
  std::map<std::string, Cell> groups;
  for (const TestOutcome& outcome : outcomes) {
    const DatasetTest& test = tests.tests[outcome.test];
    add_outcome(groups[test.group], test, outcome);
  }
  for (const std::string& name : tests.groups()) {
    const Cell& cell = groups[name];
    table.rows.push_back({name, std::to_string(cell.asked), std::to_string(cell.right),
                          percent(cell.asked > 0 ? double(cell.right) / cell.asked : std::nan("")),
                          fixed(mean(cell.inliers), 1), percent(mean(cell.confidence), 0),
                          fixed(mean(cell.iou), 2)});
  }
  table.note =
      "Missed objects count as no matched feature; confidence and overlap are means over those "
      "found.";
  Table paper;
  paper.title = "The paper's pictures";
  paper.header = {"picture", "matched features", "confidence"};
  paper.rows = {{"not hidden (a)", "98", "38 %"},
                {"hidden (b)", "49", "33 %"},
                {"hidden (c)", "17", "17 %"},
                {"hidden (d)", "34", "34 %"}};
  paper.note = "The paper does not say how much is hidden; it was by the background, cut in.";
  ChartSeries recall{"recall", {}};
  for (const auto& [value, cell] : collect(tests, outcomes, &DatasetTest::occlusion))
    recall.points.push_back({value, double(cell.right) / std::max(1, cell.asked)});
  return {"Paper, fig. 8: partial occlusion",
          "",
          {table, paper},
          {{"Recall over the hidden part", {"hidden [%]", 0, 100}, {"recall", 0, 1}, {recall}}}};
}

}  // namespace posevote
