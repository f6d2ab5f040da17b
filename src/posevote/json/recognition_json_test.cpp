#include "posevote/json/recognition_json.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace posevote {
namespace {

Detection made_detection() {
  Detection detection;
  detection.object = "ricola";
  detection.view = std::string("3");
  detection.confidence = 0.38;
  detection.probability = 0.5;
  detection.log10_false_alarms = -12.5;
  detection.inliers = 98;
  detection.features_in_area = 257;
  detection.scene_from_view = {1, 2, 3, 4, 5, 6, 0.25, 8, 1};
  detection.outline = {{0, 0.5}, {10.123456F, 0}, {0, -5}};
  detection.box = {0, -5, 10.125, 5.5};
  return detection;
}

TEST(RecognitionJson, HasTheFieldsThatProgramsRelyOn) {
  RecognitionResult result;
  result.image_size = {640, 480};
  result.time_ms = {1.5, 2, 3, 4, 10.5};
  result.counts = {500, 139, 102, 98};
  result.detections.push_back(made_detection());
  EXPECT_EQ(to_line(to_json(result, "a b.jpg")),
            R"({"image":"a b.jpg","width":640,"height":480,)"
            R"("time_ms":{"detect":1.5,"match":2.0,"vote":3.0,"verify":4.0,"total":10.5},)"
            R"("counts":{"features":500,"matched":139,"clustered":102,"verified":98},)"
            R"("detections":[{"object":"ricola","view":"3","confidence":0.38,"probability":0.5,)"
            R"("log10_false_alarms":-12.5,"inliers":98,"features_in_area":257,)"
            R"("homography":[[1.0,2.0,3.0],[4.0,5.0,6.0],[0.25,8.0,1.0]],)"
            R"("outline":[[0.0,0.5],[10.12,0.0],[0.0,-5.0]],"box":[0.0,-5.0,10.13,5.5]}]})");
}

TEST(RecognitionJson, UnknownPartsAreThereWhenThereAreAny) {
  RecognitionResult result;
  EXPECT_FALSE(to_json(result, "x").contains("unknown"));
  result.unknown = {{{10, 20, 30, 40}, 55}};
  EXPECT_EQ(to_json(result, "x")["unknown"].dump(),
            R"([{"box":[10.0,20.0,30.0,40.0],"features":55}])");
}

TEST(RecognitionJson, NothingFoundIsAnEmptyList) {
  EXPECT_EQ(to_json(RecognitionResult(), "x")["detections"], Json::array());
}

TEST(RecognitionJson, AlternativesAreThereWhenThereAreAny) {
  Detection detection = made_detection();
  EXPECT_FALSE(to_json(detection).contains("alternatives"));
  detection.alternatives = {"emmi", "ovo"};
  EXPECT_EQ(to_json(detection)["alternatives"].dump(), R"(["emmi","ovo"])");
}

TEST(RecognitionJson, AnExplanationHasItsCountsAndThePoseWhenThereWasOne) {
  Explanation explanation;
  explanation.object = "ricola";
  explanation.stage = "votes";
  explanation.reason = "the votes are spread";
  explanation.option = "vote.min_votes";
  explanation.scene_features = 500;
  explanation.similar = 40;
  explanation.matched = 9;
  EXPECT_EQ(to_line(to_json(explanation)),
            R"({"object":"ricola","found":false,"stage":"votes","reason":"the votes are spread",)"
            R"("option":"vote.min_votes","scene_features":500,"similar":40,"matched":9,)"
            R"("largest_bin":0,"clusters":0})");
  explanation.best.emplace().inliers = 98;
  EXPECT_EQ(to_json(explanation)["best"]["inliers"], 98);
}

TEST(RecognitionJson, AnyTextGivesOneValidLine) {
  const Json error = error_json("bad\xff\n.png", "cannot read \"it\"");
  const std::string line = to_line(error);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_EQ(Json::parse(line)["image"], "bad\xef\xbf\xbd\n.png");
  EXPECT_EQ(Json::parse(line)["error"], "cannot read \"it\"");
}

TEST(RecognitionJson, NumbersThatJsonDoesNotHaveBecomeNull) {
  Detection detection = made_detection();
  detection.log10_false_alarms = -std::numeric_limits<double>::infinity();
  EXPECT_TRUE(Json::parse(to_line(to_json(detection)))["log10_false_alarms"].is_null());
}

}  // namespace
}  // namespace posevote
