#include "posevote/evaluate/results.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

namespace posevote {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Detection detection(const std::string& object, const cv::Rect2d& box, double probability) {
  Detection d;
  d.object = object;
  d.view = "train/" + object + ".png";
  d.box = box;
  d.confidence = d.probability = probability;
  d.log10_false_alarms = -10 * probability;
  return d;
}

TruthObject truth(const std::string& name, const cv::Rect2d& box) {
  TruthObject t;
  t.name = name;
  t.box = box;
  return t;
}

// One picture: mug right, tea claimed as book, a pan missed. One negative with a false pan.
Evaluation small_evaluation() {
  Evaluation evaluation;
  evaluation.dataset.name = "small";
  evaluation.dataset.tests.emplace_back();
  DatasetTest& test = evaluation.dataset.tests.back();
  test.image = "1.png";
  test.objects = {truth("mug", {0, 0, 10, 10}), truth("tea", {20, 0, 10, 10}),
                  truth("pan", {40, 0, 10, 10})};
  TestOutcome outcome;
  outcome.result.image_size = {100, 100};
  outcome.result.detections = {detection("mug", {0, 0, 10, 10}, 0.9),
                               detection("book", {20, 0, 10, 10}, 0.6)};
  outcome.score = score_detections(outcome.result, test, evaluation.dataset);
  evaluation.outcomes = {outcome};

  evaluation.negatives.name = "nothing";
  evaluation.negatives.tests.emplace_back();
  TestOutcome negative;
  negative.result.image_size = {100, 100};
  negative.result.detections = {detection("pan", {0, 0, 10, 10}, 0.95)};
  negative.score =
      score_detections(negative.result, evaluation.negatives.tests[0], evaluation.negatives);
  evaluation.negative_outcomes = {negative};
  return evaluation;
}

TEST(ConfusionTable, ShowsWhoTookThePlaceOfWhom) {
  const Table table = confusion_table(small_evaluation());
  EXPECT_THAT(table.header, ElementsAre("is \\ named", "(none)", "book", "pan", "tea"));
  EXPECT_THAT(table.rows, ElementsAre(ElementsAre("pan", "1", "", "", ""),
                                      ElementsAre("tea", "", "1", "", "")));
}

TEST(SetTable, CountsNegativesForTheThresholdWithoutFalsePositives) {
  Evaluation evaluation = small_evaluation();
  const auto recall_at_zero = [&] { return set_table({evaluation}).rows[0][11]; };
  EXPECT_EQ(recall_at_zero(), "0.0 %");
  evaluation.negative_outcomes.clear();
  EXPECT_EQ(recall_at_zero(), "33.3 %");
}

TEST(SetTable, SumsSeveralSets) {
  const Evaluation evaluation = small_evaluation();
  EXPECT_EQ(set_table({evaluation}).rows.size(), 1U);
  const Table table = set_table({evaluation, evaluation});
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_THAT(table.rows[2], ElementsAre("all", "", "", "2", "6", "2", "33.3 %", "9.7..70.0", "2",
                                         "0", "2 / 2", "", "", ""));
}

TEST(MistakesOf, NamesEachKindOnce) {
  EXPECT_THAT(mistakes_of(small_evaluation()),
              ElementsAre("Missed: pan, tea.", "Wrong name: book for tea."));
  EXPECT_THAT(mistakes_of(Evaluation()), IsEmpty());
}

TEST(MistakesOf, TellsAWrongPlaceFromASecondReportAndFromNothing) {
  Evaluation evaluation = small_evaluation();
  TestOutcome& outcome = evaluation.outcomes[0];
  outcome.result.detections = {
      detection("mug", {0, 0, 10, 10}, 0.9), detection("mug", {0, 1, 10, 10}, 0.8),
      detection("tea", {24, 4, 10, 10}, 0.7), detection("tea", {23, 4, 10, 10}, 0.6),
      detection("pan", {80, 80, 10, 10}, 0.5)};
  outcome.score = score_detections(outcome.result, evaluation.dataset.tests[0], evaluation.dataset);
  EXPECT_THAT(mistakes_of(evaluation),
              ElementsAre("Missed: pan, tea.", "Right name, wrong place: tea 2.",
                          "Reported twice: mug.", "Nothing listed there: pan."));
}

TEST(RankWithNegatives, TakesOnlyFalseOnesFromTheNegatives) {
  Evaluation evaluation = small_evaluation();
  evaluation.negatives = evaluation.dataset;
  evaluation.negative_outcomes = evaluation.outcomes;
  EXPECT_EQ(rank_with_negatives(evaluation, ranking("probability")).size(), 3U);
}

TEST(ToJson, HoldsCountsGroupsAndNegatives) {
  const auto json = nlohmann::json::parse(to_json(small_evaluation()));
  EXPECT_EQ(json["dataset"], "small");
  EXPECT_EQ(json["all"]["asked"], 3);
  EXPECT_EQ(json["all"]["right"], 1);
  EXPECT_EQ(json["all"]["false_positives"], 1);
  EXPECT_EQ(json["groups"].size(), 1U);
  EXPECT_EQ(json["negatives"]["false_positives"], 1);
  EXPECT_EQ(json["negatives"]["recall"], nullptr);
}

TEST(ToJsonLines, HasALineForEveryDetectionAndEveryMiss) {
  std::vector<std::string> verdicts;
  std::istringstream lines(to_json_lines(small_evaluation()));
  for (std::string line; std::getline(lines, line);)
    verdicts.push_back(nlohmann::json::parse(line)["verdict"]);
  EXPECT_THAT(verdicts, ElementsAre("right", "false", "missed", "missed", "false"));
}

TEST(GroupTable, EndsWithTheWholeSet) {
  const Table table = group_table(small_evaluation());
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][0], "(no group)");
  EXPECT_EQ(table.rows[1][0], "all");
  EXPECT_EQ(table.rows[1][4], "33.3 %");
}

TEST(ConfusionTable, OfAPerfectRunIsEmpty) {
  EXPECT_THAT(confusion_table(Evaluation()).rows, IsEmpty());
}

}  // namespace
}  // namespace posevote
