// Table II: backgrounds; table III: resolutions.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "posevote/evaluate/paper_parts.hpp"
#include "posevote/evaluate/summary.hpp"

namespace posevote {
namespace {

constexpr const char* backgrounds[] = {"*homogeneous", "*weak", "*strong"};

std::vector<std::string> asked_names(const Dataset& dataset) {
  std::set<std::string> names;
  for (const DatasetTest& test : dataset.tests)
    for (const TruthObject& truth : test.objects)
      if (truth.asked()) names.insert(truth.name);
  return {names.begin(), names.end()};
}

// At most `count` views, evenly spread over the list.
Dataset with_views(Dataset dataset, std::size_t count) {
  for (DatasetObject& object : dataset.objects) {
    std::vector<DatasetView> kept;
    const std::size_t all = object.views.size();
    for (std::size_t i = 0; i < std::min(count, all); ++i)
      kept.push_back(object.views[all <= count ? i : i * all / count]);
    object.views = std::move(kept);
  }
  return dataset;
}

std::string rate(const Summary& s) {
  return percent(s.recall(), 0) +
         (s.false_positives > 0 ? " (" + std::to_string(s.false_positives) + ")" : "");
}

Table background_table(const std::string& title, const Dataset& dataset, const Method& method) {
  Table table;
  table.title = title;
  table.header = {"object", "homogeneous", "weak", "strong"};
  const TaughtMethod taught(dataset, method);
  const auto names = asked_names(dataset);
  for (const std::string& name : names) table.rows.push_back({name});
  table.rows.push_back({"all"});
  for (const char* background : backgrounds) {
    const Dataset tests = with_groups(dataset, background);
    const auto outcomes = taught.run(tests);
    for (std::size_t i = 0; i < names.size(); ++i)
      table.rows[i].push_back(rate(summarize("", tests, outcomes, [&](const DatasetTest& test) {
        return std::ranges::any_of(test.objects,
                                   [&](const TruthObject& t) { return t.name == names[i]; });
      })));
    table.rows.back().push_back(rate(summarize("", tests, outcomes)));
  }
  return table;
}

double megapixels_of(const std::string& group) {
  const auto begin = group.find_last_of(' ') + 1;
  double value = 0;
  std::from_chars(group.data() + begin, group.data() + group.size(), value);
  return value;
}

}  // namespace

ReportSection paper_table2(const Dataset& dataset, const Method& method) {
  Dataset tests = dataset;
  std::erase_if(tests.tests, [](const DatasetTest& test) {
    return std::ranges::none_of(backgrounds,
                                [&](auto* p) { return matches_pattern(test.group, p); });
  });
  if (tests.tests.empty()) refuse(dataset, "table2", "group '... homogeneous', '... weak', ...");
  const Dataset only_asked = with_objects(tests, asked_names(tests));
  Table paper;
  paper.title = "The paper's objects";
  paper.header = {"object", "homogeneous", "weak", "strong"};
  paper.rows = {
      {"bscup", "100 %", "90 % (1)", "100 %"},        {"nizoral", "100 %", "100 % (2)", "90 %"},
      {"perrier", "100 %", "100 % (1)", "100 % (2)"}, {"ricola", "100 %", "100 % (1)", "100 %"},
      {"truck", "100 %", "90 %", "70 % (1)"},         {"all", "100 %", "96 % (5)", "92 % (3)"}};
  paper.note = "Recognition rate, false positives in brackets; 10 pictures for each cell.";
  return {"Paper, table II: backgrounds",
          "",
          {background_table("Ours, these objects taught from at most 5 views as in the paper",
                            with_views(only_asked, 5), method),
           background_table("Ours, all objects and views of the set taught", tests, method), paper},
          {}};
}

ReportSection paper_table3(const Dataset& dataset, const Method& method) {
  const Dataset tests = with_groups(dataset, "*mp");
  if (tests.tests.empty()) refuse(dataset, "table3", "group that ends with '4mp' or '8mp'");
  Table table;
  table.title = "Table III: resolution of teaching and scene";
  table.header = {"teaching",       "scene MP", "s per scene",    "known per scene",
                  "true per scene", "recall",   "false per scene"};
  for (const double factor : {1.0, std::sqrt(0.5)}) {
    const TaughtMethod taught(
        teach_dataset(tests, method.teach, method.jobs,
                      task(method.progress, dataset.name + ": teaching"), factor),
        method);
    for (const std::string& group : tests.groups()) {
      const Dataset one = with_groups(tests, group);
      const Summary s = summarize("", one, taught.run(one));
      table.rows.push_back({factor == 1.0 ? "as stored" : "half the pixels",
                            fixed(megapixels_of(group), 0), fixed(s.total.median_ms / 1000, 2),
                            fixed(double(s.asked) / s.images, 1),
                            fixed(double(s.right) / s.images, 1), percent(s.recall()),
                            fixed(s.false_positives_per_image(), 2)});
    }
  }
  if (thread_count(method.jobs) > 1)
    table.note = std::to_string(thread_count(method.jobs)) +
                 " pictures were recognised at a time, which makes each slower.";
  Table paper;
  paper.title = "The paper's table: 50 objects on the table, 15 of the 25 known";
  paper.header = {"teaching MP", "scene MP", "s per scene", "true", "false"};
  paper.rows = {{"4", "4", "20", "5", "1"},
                {"4", "8", "26", "12", "0"},
                {"8", "4", "53", "6", "1"},
                {"8", "8", "117", "12", "0"}};
  return {"Paper, table III: resolution", "", {table, paper}, {}};
}

}  // namespace posevote
