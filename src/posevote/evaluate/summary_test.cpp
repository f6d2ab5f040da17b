#include "posevote/evaluate/summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

using testing::SizeIs;

// A test picture with one asked object and detections of the given verdicts and probabilities.
TestOutcome outcome(std::size_t test, const std::vector<std::pair<Verdict, double>>& detections,
                    double total_ms = 0) {
  TestOutcome result;
  result.test = test;
  result.score.asked = 1;
  result.result.time_ms.total = total_ms;
  for (const auto& [verdict, probability] : detections) {
    Detection detection;
    detection.probability = probability;
    result.result.detections.push_back(detection);
    result.score.judgements.push_back({verdict, -1, 0});
    if (verdict == Verdict::right) ++result.score.right;
    if (verdict == Verdict::false_positive) ++result.score.false_positives;
    if (verdict == Verdict::twin) ++result.score.twins;
  }
  return result;
}

Dataset two_groups() {
  Dataset dataset;
  for (const char* group : {"easy", "hard", "easy"}) {
    dataset.tests.emplace_back();
    dataset.tests.back().group = group;
  }
  return dataset;
}

TEST(Summarize, CountsByGroupAndWhole) {
  const std::vector<TestOutcome> outcomes{
      outcome(0, {{Verdict::right, 0.9}}, 10),
      outcome(1, {{Verdict::false_positive, 0.5}, {Verdict::twin, 0.4}}, 40), outcome(2, {}, 20)};
  const auto groups = summarize_groups(two_groups(), outcomes);
  ASSERT_THAT(groups, SizeIs(2));
  EXPECT_EQ(groups[0].name, "easy");
  EXPECT_EQ(groups[0].images, 2);
  EXPECT_DOUBLE_EQ(groups[0].recall(), 0.5);
  EXPECT_DOUBLE_EQ(groups[0].precision(), 1);
  EXPECT_DOUBLE_EQ(groups[1].false_positives_per_image(), 1);
  const Summary whole = summarize("all", two_groups(), outcomes);
  EXPECT_EQ(whole.asked, 3);
  EXPECT_EQ(whole.right, 1);
  EXPECT_EQ(whole.twins, 1);
  EXPECT_DOUBLE_EQ(whole.precision(), 0.5);
  EXPECT_DOUBLE_EQ(whole.total.median_ms, 20);
}

TEST(Summarize, OfNothingHasNoShares) {
  const Summary empty = summarize("all", Dataset(), {});
  EXPECT_TRUE(std::isnan(empty.recall()));
  EXPECT_TRUE(std::isnan(empty.precision()));
  EXPECT_TRUE(std::isnan(empty.false_positives_per_image()));
  EXPECT_TRUE(std::isnan(empty.total.median_ms));
}

TEST(Summarize, LeavesUnreadablePicturesOutOfTheTimes) {
  TestOutcome broken = outcome(0, {});
  broken.error = "cannot read it";
  const Summary summary = summarize("all", two_groups(), {broken, outcome(1, {}, 30)});
  EXPECT_EQ(summary.unreadable, 1);
  EXPECT_EQ(summary.asked, 2);
  EXPECT_DOUBLE_EQ(summary.total.median_ms, 30);
}

TEST(RankDetections, LeavesTwinsAndIgnoredOut) {
  const auto ranked = rank_detections({outcome(0, {{Verdict::right, 0.9},
                                                   {Verdict::twin, 0.8},
                                                   {Verdict::ignored, 0.7},
                                                   {Verdict::false_positive, 0.6}})},
                                      ranking("probability"));
  ASSERT_THAT(ranked, SizeIs(2));
  EXPECT_TRUE(ranked[0].right);
  EXPECT_DOUBLE_EQ(ranked[1].value, 0.6);
}

TEST(Ranking, OfAnUnknownNameIsAnError) {
  EXPECT_THROW(static_cast<void>(ranking("luck")), Error);
}

TEST(MakeCurve, GoesFromSureToUnsureAndTakesEqualValuesTogether) {
  const auto curve = make_curve({{0.5, true}, {0.9, true}, {0.5, false}, {0.2, false}});
  ASSERT_THAT(curve, SizeIs(3));
  EXPECT_DOUBLE_EQ(curve[0].threshold, 0.9);
  EXPECT_EQ(curve[0].right, 1);
  EXPECT_EQ(curve[0].false_positives, 0);
  EXPECT_EQ(curve[1].right, 2);
  EXPECT_EQ(curve[1].false_positives, 1);
  EXPECT_EQ(curve[2].false_positives, 2);
  EXPECT_TRUE(make_curve({}).empty());
}

TEST(RecallWithoutFalsePositives, CountsWhatIsStrictlyAboveTheBestFalseOne) {
  EXPECT_DOUBLE_EQ(
      recall_without_false_positives({{0.9, true}, {0.7, true}, {0.7, false}, {0.1, true}}, 4),
      0.25);
  EXPECT_DOUBLE_EQ(recall_without_false_positives({{0.9, true}, {0.1, true}}, 4), 0.5);
  EXPECT_DOUBLE_EQ(recall_without_false_positives({{0.9, false}}, 4), 0);
  EXPECT_TRUE(std::isnan(recall_without_false_positives({}, 0)));
}

}  // namespace
}  // namespace posevote
