#include "posevote/evaluate/paper.hpp"

#include <algorithm>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/paper_parts.hpp"

namespace posevote {
namespace {

struct Result {
  const char* name;
  ReportSection (*make)(const Dataset&, const Method&);
  const char* groups;  // a pattern that a dataset for it has
};

const Result results[] = {
    {"table1", paper_table1, "*weak*"},          {"fig5", paper_fig5, "yaw"},
    {"accumulator", paper_accumulator, nullptr}, {"table2", paper_table2, "*homogeneous"},
    {"fig8", paper_fig8, "occlusion *"},         {"table3", paper_table3, "*mp"}};

}  // namespace

const std::vector<std::string>& paper_result_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Result& result : results) list.emplace_back(result.name);
    return list;
  }();
  return names;
}

ReportSection reproduce(const std::string& name, const Dataset& dataset, const Method& method) {
  for (const Result& result : results)
    if (name == result.name) return result.make(dataset, method);
  const std::string nearest = nearest_word(name, paper_result_names());
  throw Error(ErrorCode::invalid_argument,
              "the paper has no result '" + name + "'" +
                  (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

std::vector<std::string> results_for(const Dataset& dataset) {
  std::vector<std::string> names;
  for (const Result& result : results)
    if (result.groups != nullptr && !with_groups(dataset, result.groups).tests.empty())
      names.emplace_back(result.name);
  return names;
}

Dataset with_groups(Dataset dataset, const std::string& pattern) {
  std::erase_if(dataset.tests,
                [&](const DatasetTest& test) { return !matches_pattern(test.group, pattern); });
  return dataset;
}

Dataset with_objects(Dataset dataset, const std::vector<std::string>& names) {
  std::erase_if(dataset.objects, [&](const DatasetObject& object) {
    return std::ranges::count(names, object.name) == 0;
  });
  return dataset;
}

const Detection* right_detection(const TestOutcome& outcome, int truth) {
  for (std::size_t i = 0; i < outcome.score.judgements.size(); ++i) {
    const Judgement& judgement = outcome.score.judgements[i];
    if (judgement.verdict == Verdict::right && judgement.truth == truth)
      return &outcome.result.detections[i];
  }
  return nullptr;
}

void refuse(const Dataset& dataset, const std::string& result, const std::string& what) {
  throw Error(ErrorCode::invalid_argument,
              result + " cannot be made of dataset " + dataset.name + ": it has no " + what);
}

}  // namespace posevote
