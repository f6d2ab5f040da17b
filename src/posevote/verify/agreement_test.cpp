#include "posevote/verify/agreement.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "posevote/verify/presence.hpp"

namespace posevote {
namespace {

const std::vector<cv::Point2f> kCorners = {{20, 20}, {140, 20}, {140, 140}, {20, 140}};

cv::Mat blobs(int seed) {
  cv::Mat picture(160, 160, CV_8UC3);
  cv::RNG(static_cast<std::uint64_t>(seed) * 0x9E3779B97F4A7C15U)
      .fill(picture, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(picture, picture, {}, 5);
  cv::normalize(picture, picture, 0, 255, cv::NORM_MINMAX);
  return picture;
}

Patch whole(const cv::Mat& picture) {
  return make_patch(picture, cv::Mat(picture.size(), CV_8U, cv::Scalar(255)));
}

/// The picture under a pose on a grey ground.
cv::Mat placed(const cv::Mat& picture, const cv::Matx33d& pose) {
  cv::Mat scene(480, 640, CV_8UC3, cv::Scalar::all(128));
  cv::warpPerspective(picture, scene, pose, scene.size(), cv::INTER_LINEAR, cv::BORDER_TRANSPARENT);
  return scene;
}

TEST(MeasureAgreement, IsHighUnderTheTruePoseAtAnySize) {
  for (const double scale : {0.2, 0.5, 1.0, 2.5}) {
    const cv::Matx33d pose(scale, 0.1 * scale, 60, -0.1 * scale, scale, 80, 0, 0, 1);
    const auto agreement =
        measure_agreement(whole(blobs(1)), pose, kCorners, ScenePyramid(placed(blobs(1), pose)));
    EXPECT_GT(agreement.structure, 0.7) << scale;
    EXPECT_GT(agreement.structure_near_matches, 0.7) << scale;
    EXPECT_LT(agreement.colour_difference, 0.1) << scale;
    EXPECT_NEAR(agreement.visible, 1, 0.02) << scale;
  }
}

TEST(MeasureAgreement, IsLowForAnotherPictureAndAShiftedPose) {
  const cv::Matx33d pose(1, 0, 200, 0, 1, 100, 0, 0, 1), shifted(1, 0, 240, 0, 1, 130, 0, 0, 1);
  const ScenePyramid scene(placed(blobs(1), pose));
  EXPECT_LT(measure_agreement(whole(blobs(2)), pose, kCorners, scene).structure, 0.3);
  EXPECT_LT(measure_agreement(whole(blobs(1)), shifted, kCorners, scene).structure, 0.3);
}

TEST(MeasureAgreement, FindsTheRimOnlyWhereTheObjectEnds) {
  const cv::Matx33d pose(1, 0, 200, 0, 1, 100, 0, 0, 1), shifted(1, 0, 240, 0, 1, 130, 0, 0, 1),
      small(0.6, 0, 230, 0, 0.6, 130, 0, 0, 1), cut(1, 0, -40, 0, 1, 100, 0, 0, 1);
  const auto rim_at = [](const cv::Matx33d& at, const cv::Mat& scene) {
    return measure_agreement(whole(blobs(1)), at, kCorners, ScenePyramid(scene)).rim;
  };
  const cv::Mat scene = placed(blobs(1) * 0.3, pose);
  EXPECT_GT(rim_at(pose, scene), 0.6);
  EXPECT_GT(rim_at(cut, placed(blobs(1) * 0.3, cut)), 0.6);
  EXPECT_NEAR(rim_at(cv::Matx33d::eye(), blobs(1)), 0.55, 0.05) << "nothing of the rim is seen";
  EXPECT_LT(rim_at(shifted, scene), 0.7 * rim_at(pose, scene));
  EXPECT_LT(rim_at(small, scene), 0.7 * rim_at(pose, scene));
}

TEST(MeasureAgreement, DoesNotMindTheExposure) {
  const cv::Matx33d pose(1, 0, 200, 0, 1, 100, 0, 0, 1);
  const auto agreement = measure_agreement(whole(blobs(1)), pose, kCorners,
                                           ScenePyramid(placed(blobs(1), pose) * 0.6));
  EXPECT_GT(agreement.structure, 0.6);
  EXPECT_LT(agreement.colour_difference, 0.1);
}

TEST(MeasureAgreement, SeesAnotherColourOfTheSamePrint) {
  const cv::Matx33d pose(1, 0, 200, 0, 1, 100, 0, 0, 1);
  cv::Mat swapped;
  cv::cvtColor(placed(blobs(1), pose), swapped, cv::COLOR_BGR2RGB);
  const auto same =
      measure_agreement(whole(blobs(1)), pose, kCorners, ScenePyramid(placed(blobs(1), pose)));
  const auto other = measure_agreement(whole(blobs(1)), pose, kCorners, ScenePyramid(swapped));
  EXPECT_GT(other.colour_difference, 3 * same.colour_difference);
}

TEST(MeasureAgreement, KnowsHowMuchIsInThePicture) {
  const cv::Matx33d half_out(1, 0, -80, 0, 1, 100, 0, 0, 1), out(1, 0, -900, 0, 1, 0, 0, 0, 1);
  const ScenePyramid scene(placed(blobs(1), half_out));
  EXPECT_NEAR(measure_agreement(whole(blobs(1)), half_out, kCorners, scene).visible, 0.5, 0.03);
  EXPECT_EQ(measure_agreement(whole(blobs(1)), out, kCorners, scene).visible, 0);
  EXPECT_EQ(measure_agreement({}, half_out, kCorners, scene).visible, 0);
}

TEST(MeasureAgreement, TakesGreyDeepAndTinyScenes) {
  const cv::Matx33d pose(1, 0, 200, 0, 1, 100, 0, 0, 1);
  cv::Mat grey, deep;
  cv::cvtColor(placed(blobs(1), pose), grey, cv::COLOR_BGR2GRAY);
  grey.convertTo(deep, CV_16U, 256);
  for (const cv::Mat& scene : {grey, deep})
    EXPECT_GT(measure_agreement(whole(blobs(1)), pose, kCorners, ScenePyramid(scene)).structure,
              0.6);
  cv::Mat grey_bgr;
  cv::cvtColor(grey, grey_bgr, cv::COLOR_GRAY2BGR);
  for (const cv::Mat& scene : {grey, grey_bgr}) {
    EXPECT_FALSE(ScenePyramid(scene).has_colour());
    EXPECT_LT(
        measure_agreement(whole(blobs(1)), pose, kCorners, ScenePyramid(scene)).colour_difference,
        0.1);
  }
  const ScenePyramid tiny(cv::Mat(1, 1, CV_8U, cv::Scalar(3)));
  EXPECT_LE(measure_agreement(whole(blobs(1)), pose, kCorners, tiny).structure, 0.1);
}

PresenceEvidence convincing() {
  return {200, 0.3, 0.7, 0.05, {0.8, 0.85, 0.05, 0.7, 1}, 0.6, 0.85};
}

TEST(RatePresence, IsSureOfAnObjectThatAgreesInEveryWay) {
  EXPECT_GT(rate_presence(convincing()).probability(), 0.98);
}

TEST(RatePresence, DoubtsASharedLogoOnAnotherThing) {
  const PresenceEvidence logo{25, 0.03, 0.05, 0.05, {0.15, 0.8, 0.25, 0.4, 1}};
  EXPECT_LT(rate_presence(logo).object(), 0.5);
}

TEST(RatePresence, FallsWithEveryKindOfEvidence) {
  const double sure = rate_presence(convincing()).probability();
  auto fewer_digits = convincing(), other_colour = convincing(), other_picture = convincing();
  auto no_rim = convincing(), no_consensus = convincing();
  fewer_digits.digits = 2;
  no_rim.agreement.rim = 0.2;
  no_consensus.consensus = 0.3;
  other_colour.agreement.colour_difference = 0.6;
  other_picture.agreement.structure = other_picture.agreement.structure_near_matches = 0.05;
  for (const auto& evidence : {fewer_digits, other_colour, other_picture, no_rim, no_consensus})
    EXPECT_LT(rate_presence(evidence).probability(), sure);
}

TEST(LeastProbability, FallsWithTheNumberOfFalseAlarmsAllowed) {
  double last = 1;
  for (const double dial : {1e-3, 1.0, 10.0, 100.0, 1e6}) {
    const double least = least_probability(dial);
    EXPECT_LT(least, last);
    EXPECT_GT(least, 0);
    last = least;
  }
}

}  // namespace
}  // namespace posevote
