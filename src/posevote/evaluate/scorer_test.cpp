#include "posevote/evaluate/scorer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace posevote {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr auto right = Verdict::right;
constexpr auto wrong = Verdict::false_positive;
constexpr auto twin = Verdict::twin;
constexpr auto ignored = Verdict::ignored;

const cv::Size picture{640, 480};
const cv::Rect2d place{100, 100, 100, 100};
const cv::Rect2d elsewhere{400, 100, 100, 100};

TruthObject truth(const std::string& name, const cv::Rect2d& box, double visible = 1,
                  bool optional = false) {
  TruthObject object;
  object.name = name;
  object.box = box;
  object.visible = visible;
  object.optional = optional;
  return object;
}

Score score(const std::vector<Claim>& claims, const std::vector<TruthObject>& truths) {
  Dataset dataset;
  dataset.twins = {{"mint", "cherry"}};
  DatasetTest test;
  test.objects = truths;
  return score_claims(claims, test, dataset, picture);
}

std::vector<Verdict> verdicts(const Score& score) {
  std::vector<Verdict> list;
  for (const Judgement& judgement : score.judgements) list.push_back(judgement.verdict);
  return list;
}

TEST(ClippedIou, OfEqualBoxesIsOne) {
  EXPECT_DOUBLE_EQ(clipped_iou(place, place, picture), 1);
}

TEST(ClippedIou, IsCommonAreaOverUnion) {
  EXPECT_DOUBLE_EQ(clipped_iou({0, 0, 10, 10}, {5, 0, 10, 10}, picture), 50.0 / 150);
  EXPECT_DOUBLE_EQ(clipped_iou({0, 0, 10, 10}, {10, 0, 10, 10}, picture), 0);
}

TEST(ClippedIou, CutsBothBoxesToThePicture) {
  EXPECT_DOUBLE_EQ(clipped_iou({-100, 0, 200, 50}, {0, 0, 100, 50}, picture), 1);
  EXPECT_DOUBLE_EQ(clipped_iou({600, 400, 500, 500}, {600, 400, 40, 80}, picture), 1);
}

TEST(ClippedIou, OfABoxOutsideIsZero) {
  const cv::Rect2d outside{700, 100, 50, 50};
  EXPECT_DOUBLE_EQ(clipped_iou(outside, outside, picture), 0);
  EXPECT_DOUBLE_EQ(clipped_iou({10, 10, 0, 0}, {10, 10, 0, 0}, picture), 0);
}

TEST(ScoreClaims, NothingAskedAndNothingClaimedIsEmpty) {
  const Score result = score({}, {});
  EXPECT_EQ(result.asked, 0);
  EXPECT_THAT(result.judgements, IsEmpty());
  EXPECT_THAT(result.missed, IsEmpty());
}

TEST(ScoreClaims, RightNameAtTheRightPlaceIsRight) {
  const Score result = score({{"mug", place, 0.5}}, {truth("mug", place)});
  EXPECT_THAT(verdicts(result), ElementsAre(right));
  EXPECT_EQ(result.judgements[0].truth, 0);
  EXPECT_DOUBLE_EQ(result.judgements[0].iou, 1);
  EXPECT_EQ(result.asked, 1);
  EXPECT_EQ(result.right, 1);
  EXPECT_THAT(result.missed, IsEmpty());
}

TEST(ScoreClaims, HalfOfTheUnionIsEnoughAndLessIsNot) {
  // 100 x 100 against 100 x 200: exactly one half.
  const auto tall = truth("mug", {100, 100, 100, 200});
  EXPECT_THAT(verdicts(score({{"mug", place, 1}}, {tall})), ElementsAre(right));
  EXPECT_THAT(verdicts(score({{"mug", {100, 100, 100, 99.9}, 1}}, {tall})), ElementsAre(wrong));
}

TEST(ScoreClaims, WrongNameIsAFalsePositiveAndTheObjectIsMissed) {
  const Score result = score({{"book", place, 1}}, {truth("mug", place)});
  EXPECT_THAT(verdicts(result), ElementsAre(wrong));
  EXPECT_THAT(result.missed, ElementsAre(0));
  EXPECT_EQ(result.judgements[0].truth, 0);
}

TEST(ScoreClaims, RightNameAtTheWrongPlaceIsAFalsePositive) {
  const Score result = score({{"mug", elsewhere, 1}}, {truth("mug", place)});
  EXPECT_THAT(verdicts(result), ElementsAre(wrong));
  EXPECT_EQ(result.judgements[0].truth, -1);
}

TEST(ScoreClaims, ReportingAnInstanceAgainIsAFalsePositive) {
  const Score result = score({{"mug", place, 0.4}, {"mug", place, 0.9}}, {truth("mug", place)});
  EXPECT_THAT(verdicts(result), ElementsAre(wrong, right));
  EXPECT_EQ(result.false_positives, 1);
}

TEST(ScoreClaims, TheMoreConfidentClaimComesFirstEvenIfItFitsWorse) {
  const Score result =
      score({{"mug", place, 0.4}, {"mug", {100, 100, 100, 60}, 0.9}}, {truth("mug", place)});
  EXPECT_THAT(verdicts(result), ElementsAre(wrong, right));
}

TEST(ScoreClaims, EqualConfidenceKeepsTheOrderGiven) {
  const Score result = score({{"mug", place, 0.5}, {"mug", place, 0.5}}, {truth("mug", place)});
  EXPECT_THAT(verdicts(result), ElementsAre(right, wrong));
}

TEST(ScoreClaims, AnObjectListedTwiceIsThereTwice) {
  const std::vector<TruthObject> two{truth("mug", place), truth("mug", elsewhere)};
  Score result = score({{"mug", elsewhere, 0.9}, {"mug", place, 0.5}}, two);
  EXPECT_THAT(verdicts(result), ElementsAre(right, right));
  EXPECT_EQ(result.judgements[0].truth, 1);
  result = score({{"mug", elsewhere, 0.9}, {"mug", elsewhere, 0.5}}, two);
  EXPECT_THAT(verdicts(result), ElementsAre(right, wrong));
  EXPECT_THAT(result.missed, ElementsAre(0));
}

TEST(ScoreClaims, OverlappingInstancesAreTakenByTheBestOverlap) {
  const std::vector<TruthObject> two{truth("mug", place), truth("mug", {120, 100, 100, 100})};
  const Score result = score({{"mug", {118, 100, 100, 100}, 0.9}, {"mug", place, 0.5}}, two);
  EXPECT_THAT(verdicts(result), ElementsAre(right, right));
  EXPECT_EQ(result.judgements[0].truth, 1);
  EXPECT_EQ(result.judgements[1].truth, 0);
}

TEST(ScoreClaims, BoxesAreComparedInsideThePicture) {
  const Score result =
      score({{"mug", {-300, 100, 400, 100}, 1}}, {truth("mug", {0, 100, 100, 100})});
  EXPECT_THAT(verdicts(result), ElementsAre(right));
}

TEST(ScoreClaims, AClaimOutsideThePictureIsAFalsePositive) {
  const cv::Rect2d outside{-200, -200, 100, 100};
  EXPECT_THAT(verdicts(score({{"mug", outside, 1}}, {truth("mug", outside)})), ElementsAre(wrong));
}

TEST(ScoreClaims, HiddenAndOptionalObjectsAreNeitherAskedForNorWrong) {
  for (const auto& object : {truth("mug", place, 0.149), truth("mug", place, 1, true)}) {
    const Score missed = score({}, {object});
    EXPECT_EQ(missed.asked, 0);
    EXPECT_THAT(missed.missed, IsEmpty());
    const Score reported = score({{"mug", place, 1}, {"mug", place, 0.5}}, {object});
    EXPECT_THAT(verdicts(reported), ElementsAre(ignored, ignored));
    EXPECT_EQ(reported.right, 0);
    EXPECT_EQ(reported.false_positives, 0);
  }
}

TEST(ScoreClaims, AnAskedInstanceIsPreferredToAnOptionalOne) {
  const std::vector<TruthObject> two{truth("mug", place, 1, true),
                                     truth("mug", {105, 100, 100, 100})};
  EXPECT_THAT(verdicts(score({{"mug", place, 1}}, two)), ElementsAre(right));
}

TEST(ScoreClaims, TheTwinsNameIsNeitherRightNorWrong) {
  const Score result = score({{"cherry", place, 1}}, {truth("mint", place)});
  EXPECT_THAT(verdicts(result), ElementsAre(twin));
  EXPECT_EQ(result.twins, 1);
  EXPECT_EQ(result.right, 0);
  EXPECT_EQ(result.false_positives, 0);
  EXPECT_THAT(result.missed, ElementsAre(0));
}

TEST(ScoreClaims, ATwinMustFitTheBoxToo) {
  EXPECT_THAT(verdicts(score({{"cherry", elsewhere, 1}}, {truth("mint", place)})),
              ElementsAre(wrong));
}

TEST(ScoreClaims, OnesOwnInstanceComesBeforeTheTwins) {
  const std::vector<TruthObject> two{truth("mint", place), truth("cherry", {110, 100, 100, 100})};
  const Score result = score({{"cherry", place, 1}}, two);
  EXPECT_THAT(verdicts(result), ElementsAre(right));
  EXPECT_EQ(result.judgements[0].truth, 1);
}

TEST(ScoreClaims, TheRightNameIsStillRightAfterTheTwins) {
  const Score result =
      score({{"cherry", place, 0.9}, {"mint", place, 0.5}}, {truth("mint", place)});
  EXPECT_THAT(verdicts(result), ElementsAre(twin, right));
  EXPECT_THAT(result.missed, IsEmpty());
}

TEST(ScoreClaims, ReportingAnInstanceAgainByItsTwinsNameIsAFalsePositive) {
  EXPECT_THAT(
      verdicts(score({{"mint", place, 0.9}, {"cherry", place, 0.5}}, {truth("mint", place)})),
      ElementsAre(right, wrong));
  EXPECT_THAT(
      verdicts(score({{"cherry", place, 0.9}, {"cherry", place, 0.5}}, {truth("mint", place)})),
      ElementsAre(twin, wrong));
}

TEST(ScoreClaims, TheTwinOfAHiddenObjectIsIgnored) {
  EXPECT_THAT(verdicts(score({{"cherry", place, 1}}, {truth("mint", place, 0.1)})),
              ElementsAre(ignored));
}

TEST(ScoreClaims, EveryClaimInAPictureWithoutObjectsIsAFalsePositive) {
  EXPECT_THAT(verdicts(score({{"mug", place, 1}, {"book", place, 1}}, {})),
              ElementsAre(wrong, wrong));
}

}  // namespace
}  // namespace posevote
