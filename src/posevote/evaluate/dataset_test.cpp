#include "posevote/evaluate/dataset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Dataset parse(const std::string& text) {
  return parse_dataset(text, "folder", "dataset.json");
}

std::string error_of(const std::string& text) {
  try {
    static_cast<void>(parse(text));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
    return error.what();
  }
  return "";
}

TEST(LoadDataset, ReadsTheDemo) {
  const Dataset demo = load_dataset(POSEVOTE_SOURCE_DIR "/data/demo");
  EXPECT_EQ(demo.name, "demo");
  EXPECT_EQ(demo.objects.size(), 8U);
  EXPECT_EQ(demo.tests.size(), 8U);
  EXPECT_TRUE(demo.are_twins("tea-cherry", "tea-mint"));
  EXPECT_FALSE(demo.are_twins("tea-mint", "tea-mint"));
  EXPECT_FALSE(demo.are_twins("tea-mint", "mug"));
  EXPECT_THAT(demo.groups(),
              ElementsAre("tidy", "cluttered", "occluded", "two copies", "nothing known"));
  const DatasetView& view = demo.objects[0].views[1];
  EXPECT_EQ(view.yaw_deg, 36);
  EXPECT_FALSE(view.background.empty());
  EXPECT_TRUE(std::filesystem::exists(demo.path(view.truth_mask)));
}

TEST(LoadDataset, TakesTheFileAsWellAsItsFolder) {
  EXPECT_EQ(load_dataset(POSEVOTE_SOURCE_DIR "/data/demo/dataset.json").folder,
            load_dataset(POSEVOTE_SOURCE_DIR "/data/demo").folder);
}

TEST(LoadDataset, SaysWhichFileIsMissing) {
  try {
    static_cast<void>(load_dataset("/nowhere/at/all"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::io);
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/at/all"));
  }
}

TEST(ParseDataset, ReadsEveryField) {
  const Dataset dataset = parse(R"({"name": "n", "description": "d", "comment": 1,
    "objects": [{"name": "a", "views": [{"image": "a.png", "mask": "m.png", "yaw": -30}]}],
    "tests": [{"image": "t.jpg", "group": "g", "yaw": 1, "roll": 2, "scale": 3, "occlusion": 4,
      "objects": [{"name": "a", "box": [1, 2.5, 3, 4], "visible": 0.5, "yaw": 75,
                   "optional": true, "quad": [[0, 0], [1, 0], [1, 1], [-5, 1]]}]}],
    "twins": [["a", "b"]]})");
  EXPECT_EQ(dataset.description, "d");
  EXPECT_EQ(dataset.objects[0].views[0].mask, "m.png");
  EXPECT_EQ(dataset.objects[0].views[0].yaw_deg, -30);
  const DatasetTest& test = dataset.tests[0];
  EXPECT_EQ(test.group, "g");
  EXPECT_EQ(test.yaw_deg, 1);
  EXPECT_EQ(test.roll_deg, 2);
  EXPECT_EQ(test.scale, 3);
  EXPECT_EQ(test.occlusion, 4);
  const TruthObject& truth = test.objects[0];
  EXPECT_EQ(truth.box, cv::Rect2d(1, 2.5, 3, 4));
  EXPECT_EQ(truth.visible, 0.5);
  EXPECT_EQ(truth.corners[3], cv::Point2d(-5, 1));
  EXPECT_FALSE(truth.asked());
}

TEST(ParseDataset, FillsInWhatMayBeLeftOut) {
  const Dataset dataset = parse(R"({"objects": [{"name": "a", "views": [{"image": "a.png"}]}],
    "tests": [{"image": "t.jpg", "objects": [{"name": "a", "box": [0, 0, 1, 1]}]}]})");
  EXPECT_EQ(dataset.name, "folder");
  EXPECT_EQ(dataset.tests[0].group, "");
  EXPECT_TRUE(std::isnan(dataset.tests[0].yaw_deg));
  EXPECT_TRUE(dataset.tests[0].objects[0].asked());
  EXPECT_EQ(dataset.tests[0].objects[0].visible, 1);
}

TEST(ParseDataset, NamesThePlaceOfAMistake) {
  EXPECT_THAT(error_of("{"), HasSubstr("dataset.json is not valid JSON near byte"));
  EXPECT_THAT(error_of("[]"), HasSubstr("the file must be an object"));
  EXPECT_THAT(error_of(R"({"objects": []})"), HasSubstr("tests is missing"));
  EXPECT_THAT(error_of(R"({"objects": {}, "tests": []})"), HasSubstr("objects must be a list"));
  EXPECT_THAT(error_of(R"({"objects": [{"views": []}], "tests": []})"),
              HasSubstr("objects[0].name is missing"));
  EXPECT_THAT(error_of(R"({"objects": [], "tests": [{"image": 7, "objects": []}]})"),
              HasSubstr("tests[0].image must be a text"));
  EXPECT_THAT(error_of(R"({"objects": [], "twins": [["a"]], "tests": []})"),
              HasSubstr("twins[0] must hold at least two names"));
}

std::string error_of_truth(const std::string& truth) {
  return error_of(R"({"objects": [], "tests": [{"image": "t", "objects": [)" + truth + "]}]}");
}

TEST(ParseDataset, ChecksTheGroundTruth) {
  EXPECT_THAT(error_of_truth(R"({"name": "a", "box": [1, 2, 3]})"),
              HasSubstr("tests[0].objects[0].box must be a box"));
  EXPECT_THAT(error_of_truth(R"({"name": "a", "box": [1, 2, -3, 4]})"),
              HasSubstr("negative width"));
  EXPECT_THAT(error_of_truth(R"({"name": "a", "box": [1, 2, 3, "4"]})"),
              HasSubstr("box[3] must be a number"));
  EXPECT_THAT(error_of_truth(R"({"name": "a", "box": [1, 2, 3, 4], "visible": 1.5})"),
              HasSubstr("visible must lie in 0..1"));
  EXPECT_THAT(error_of_truth(R"({"name": "a", "box": [1, 2, 3, 4], "quad": [[0, 0]]})"),
              HasSubstr("four points"));
  EXPECT_THAT(error_of_truth(R"({"name": "a", "box": [1, 2, 3, 4], "optional": 1})"),
              HasSubstr("optional must be true or false"));
}

TEST(ParseDataset, RefusesTwoObjectsOfOneName) {
  EXPECT_THAT(error_of(R"({"objects": [{"name": "a", "views": []}, {"name": "a", "views": []}],
                          "tests": []})"),
              HasSubstr("objects[1] has the name 'a'"));
}

TEST(ParseDataset, RefusesAViewWithBackgroundAndMask) {
  EXPECT_THAT(error_of(R"({"objects": [{"name": "a", "views":
                          [{"image": "i", "background": "b", "mask": "m"}]}], "tests": []})"),
              HasSubstr("both a background and a mask"));
}

TEST(TruthObject, IsAskedForFrom15PerCentVisible) {
  TruthObject truth;
  truth.visible = 0.15;
  EXPECT_TRUE(truth.asked());
  truth.visible = 0.1499;
  EXPECT_FALSE(truth.asked());
  truth.visible = 1;
  truth.optional = true;
  EXPECT_FALSE(truth.asked());
}

Dataset with_groups(const std::vector<std::string>& groups) {
  Dataset dataset;
  for (const auto& group : groups) {
    dataset.tests.emplace_back();
    dataset.tests.back().group = group;
  }
  return dataset;
}

TEST(SelectTests, KeepsMatchingGroups) {
  const auto kept =
      select_tests(with_groups({"multi 640", "negatives", "multi 1280"}), {"multi*"}, 0);
  EXPECT_THAT(kept.groups(), ElementsAre("multi 640", "multi 1280"));
  EXPECT_THROW(static_cast<void>(select_tests(with_groups({"a"}), {"b"}, 0)), Error);
}

TEST(SelectTests, SpreadsTheLimitEvenly) {
  const auto kept = select_tests(with_groups({"0", "1", "2", "3", "4", "5"}), {}, 3);
  EXPECT_THAT(kept.groups(), ElementsAre("0", "2", "4"));
  EXPECT_EQ(select_tests(with_groups({"0", "1"}), {}, 5).tests.size(), 2U);
}

TEST(MatchesPattern, KnowsStarAndQuestionMark) {
  EXPECT_TRUE(matches_pattern("occlusion bgcut 40", "occlusion*40"));
  EXPECT_TRUE(matches_pattern("abc", "a?c"));
  EXPECT_TRUE(matches_pattern("", "*"));
  EXPECT_TRUE(matches_pattern("aXbXc", "*X*c"));
  EXPECT_FALSE(matches_pattern("abc", "a?"));
  EXPECT_FALSE(matches_pattern("abc", "abcd"));
  EXPECT_FALSE(matches_pattern("", "?"));
}

}  // namespace
}  // namespace posevote
