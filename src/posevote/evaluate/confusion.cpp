#include <algorithm>
#include <map>
#include <set>

#include "posevote/evaluate/results.hpp"

namespace posevote {
namespace {

const char* const none = "(none)";

// Who took the place of whom. A false positive that lies on a listed object is an answer to it.
std::map<std::pair<std::string, std::string>, int> count_answers(const Evaluation& evaluation) {
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const TestOutcome& outcome : evaluation.outcomes) {
    const auto& objects = evaluation.dataset.tests[outcome.test].objects;
    std::set<int> answered;
    for (std::size_t i = 0; i < outcome.score.judgements.size(); ++i) {
      const Judgement& judgement = outcome.score.judgements[i];
      if (judgement.verdict == Verdict::ignored) continue;
      const bool on_object = judgement.truth >= 0 && judgement.iou >= 0.5;
      const std::string& claimed = outcome.result.detections[i].object;
      ++counts[{on_object ? objects[static_cast<std::size_t>(judgement.truth)].name : none,
                claimed}];
      if (on_object) answered.insert(judgement.truth);
    }
    for (const int missed : outcome.score.missed)
      if (!answered.contains(missed))
        ++counts[{objects[static_cast<std::size_t>(missed)].name, none}];
  }
  return counts;
}

// "mug 3, tea": most first, then by name; once goes without a number.
std::string in_words(const std::map<std::string, int>& counts) {
  std::vector<std::pair<std::string, int>> sorted(counts.begin(), counts.end());
  std::ranges::stable_sort(sorted, std::greater{}, &std::pair<std::string, int>::second);
  std::string text;
  for (const auto& [name, count] : sorted)
    text += (text.empty() ? "" : ", ") + name + (count > 1 ? " " + std::to_string(count) : "");
  return text;
}

}  // namespace

Table confusion_table(const Evaluation& evaluation) {
  const auto counts = count_answers(evaluation);
  std::set<std::string> rows, columns;
  for (const auto& [pair, count] : counts)
    if (pair.first != pair.second) {
      rows.insert(pair.first);
      columns.insert(pair.second);
      if (pair.first != none) columns.insert(pair.first);
    }
  Table table;
  table.header = {"is \\ named"};
  table.header.insert(table.header.end(), columns.begin(), columns.end());
  for (const std::string& row : rows) {
    table.rows.push_back({row});
    for (const std::string& column : columns) {
      const auto found = counts.find({row, column});
      table.rows.back().push_back(found == counts.end() ? "" : std::to_string(found->second));
    }
  }
  table.note = "Objects that were always right and never claimed elsewhere are left out.";
  return table;
}

std::vector<std::string> mistakes_of(const Evaluation& evaluation) {
  std::map<std::string, int> missed, names, places, twice, nothing;
  for (const TestOutcome& outcome : evaluation.outcomes) {
    const auto& objects = evaluation.dataset.tests[outcome.test].objects;
    for (const int i : outcome.score.missed) ++missed[objects[static_cast<std::size_t>(i)].name];
    for (std::size_t i = 0; i < outcome.score.judgements.size(); ++i) {
      const Judgement& judgement = outcome.score.judgements[i];
      if (judgement.verdict != Verdict::false_positive) continue;
      const Detection& claimed = outcome.result.detections[i];
      const std::string truth = judgement.truth >= 0 && judgement.iou > 0
                                    ? objects[static_cast<std::size_t>(judgement.truth)].name
                                    : none;
      const bool fits = judgement.iou >= 0.5;
      if (truth == claimed.object)
        ++(fits ? twice : places)[claimed.object];
      else if (fits)
        ++names[claimed.object + " for " + truth];
      else
        ++nothing[claimed.object];
    }
  }
  std::vector<std::string> lines;
  for (const auto& [what, counts] :
       {std::pair("Missed", &missed), std::pair("Wrong name", &names),
        std::pair("Right name, wrong place", &places), std::pair("Reported twice", &twice),
        std::pair("Nothing listed there", &nothing)})
    if (!counts->empty()) lines.push_back(std::string(what) + ": " + in_words(*counts) + ".");
  return lines;
}

}  // namespace posevote
