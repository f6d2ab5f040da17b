#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "posevote/verify/evidence.hpp"
#include "posevote/verify/pose_fit.hpp"
#include "posevote/verify/scene_grid.hpp"
#include "posevote/verify/transform.hpp"

namespace posevote {
namespace {

const std::vector<cv::Point2f> kSquare = {{0, 0}, {100, 0}, {100, 100}, {0, 100}};
const cv::Matx33d kHomography(0.9, -0.3, 50, 0.25, 1.1, 20, 4e-4, -3e-4, 1);

std::vector<PointPair> pairs_of(const cv::Matx33d& transform, int per_side) {
  std::vector<PointPair> pairs;
  for (int y = 0; y < per_side; ++y)
    for (int x = 0; x < per_side; ++x) {
      const cv::Point2f view(100.F * static_cast<float>(x) / static_cast<float>(per_side - 1),
                             100.F * static_cast<float>(y) / static_cast<float>(per_side - 1));
      pairs.push_back({view, transform_point(transform, view)});
    }
  return pairs;
}

double worst_error(const cv::Matx33d& found, const cv::Matx33d& truth) {
  double worst = 0;
  for (const auto& corner : kSquare)
    worst =
        std::max(worst, cv::norm(transform_point(found, corner) - transform_point(truth, corner)));
  return worst;
}

TEST(FitTransform, RecoversEachKindExactly) {
  const cv::Matx33d similarity(1.2, -0.5, 10, 0.5, 1.2, 20, 0, 0, 1);
  const cv::Matx33d affine(1.2, -0.1, 10, 0.5, 0.8, 20, 0, 0, 1);
  EXPECT_LT(
      worst_error(fit_transform(TransformKind::similarity, pairs_of(similarity, 3)), similarity),
      1e-3);
  EXPECT_LT(worst_error(fit_transform(TransformKind::affine, pairs_of(affine, 3)), affine), 1e-3);
  EXPECT_LT(
      worst_error(fit_transform(TransformKind::homography, pairs_of(kHomography, 3)), kHomography),
      1e-2);
}

TEST(FitTransform, IsZeroForTooFewOrDegeneratePairs) {
  const PointPair one{{1, 1}, {2, 2}};
  EXPECT_EQ(cv::norm(cv::Mat(fit_transform(TransformKind::similarity, {one}))), 0);
  EXPECT_EQ(cv::norm(cv::Mat(fit_transform(TransformKind::similarity, {one, one}))), 0);
  const std::vector<PointPair> line = {{{0, 0}, {0, 0}}, {{1, 1}, {1, 1}}, {{2, 2}, {2, 2}}};
  EXPECT_EQ(cv::norm(cv::Mat(fit_transform(TransformKind::affine, line))), 0);
}

TEST(WhyImplausible, AcceptsWhatACameraCanSee) {
  EXPECT_EQ(why_implausible(cv::Matx33d::eye(), kSquare, {}), "");
  EXPECT_EQ(why_implausible(cv::Matx33d(-1, 0, 90, 0, -1, 90, 0, 0, 1), kSquare, {}), "");
}

TEST(WhyImplausible, RefusesMirroredFoldedSkewedAndBadlyScaledPoses) {
  EXPECT_EQ(why_implausible(cv::Matx33d(-1, 0, 100, 0, 1, 0, 0, 0, 1), kSquare, {}), "mirrored");
  EXPECT_EQ(why_implausible(cv::Matx33d(1, 0, 0, 0, 1, 0, -0.02, 0, 1), kSquare, {}),
            "folded over");
  EXPECT_EQ(why_implausible(cv::Matx33d(1, 0, 0, 0, 0.1, 0, 0, 0, 1), kSquare, {}), "too skewed");
  EXPECT_EQ(why_implausible(cv::Matx33d(.01, 0, 0, 0, .01, 0, 0, 0, 1), kSquare, {}), "too small");
  EXPECT_EQ(why_implausible(cv::Matx33d(50, 0, 0, 0, 50, 0, 0, 0, 1), kSquare, {}), "too large");
  EXPECT_EQ(why_implausible(cv::Matx33d::zeros(), kSquare, {}), "no transform fits");
  EXPECT_EQ(why_implausible(cv::Matx33d::eye() * std::nan(""), kSquare, {}), "no transform fits");
}

TEST(FitPose, FindsAHomographyWhenTheEvidenceIsGood) {
  const auto found = fit_pose(pairs_of(kHomography, 8), {{50, 50}, 50}, 0.5, {});
  EXPECT_LT(worst_error(found, kHomography), 1);
}

TEST(FitPose, StaysNearASimilarityWhenTheEvidenceIsPoor) {
  // Three crowded points with an error of a pixel: an affine transform through them is nonsense.
  const std::vector<PointPair> pairs = {
      {{50, 50}, {50, 50}}, {{56, 50}, {56, 51}}, {{50, 56}, {51, 55}}};
  const auto found = fit_pose(pairs, {{50, 50}, 50}, 3, {});
  EXPECT_EQ(why_implausible(found, kSquare, {}), "");
  const auto affine = fit_transform(TransformKind::affine, pairs);
  EXPECT_LT(worst_error(found, cv::Matx33d::eye()), worst_error(affine, cv::Matx33d::eye()));
}

TEST(FitPose, IsZeroWithoutTwoDifferentPoints) {
  EXPECT_EQ(cv::norm(cv::Mat(fit_pose({}, {{0, 0}, 1}, 1, {}))), 0);
}

TEST(SceneGrid, FindsTheSameAsALoopOverAll) {
  Features scene;
  cv::RNG random(7);
  for (int i = 0; i < 500; ++i)
    scene.keypoints.push_back(
        {random.uniform(-5.F, 645.F), random.uniform(-5.F, 485.F), 2, 0, 1, 0});
  const SceneGrid grid(scene, {640, 480});
  for (int i = 0; i < 50; ++i) {
    const cv::Point2f centre(random.uniform(-50.F, 700.F), random.uniform(-50.F, 500.F));
    int found = 0, expected = 0;
    grid.for_each_near(centre, 37, [&](const PlacedKeypoint&) { ++found; });
    for (const auto& k : scene.keypoints)
      expected += std::hypot(k.x - centre.x, k.y - centre.y) <= 37;
    EXPECT_EQ(found, expected);
  }
}

TEST(SceneGrid, BearsNaNAndEmptyScenes) {
  const Features none;
  const SceneGrid grid(none, {1, 1});
  int found = 0;
  grid.for_each_near({std::nanf(""), 0}, 5, [&](const PlacedKeypoint&) { ++found; });
  EXPECT_EQ(found, 0);
  EXPECT_EQ(grid.count_in({0, 0, 10, 10}), 0);
}

TEST(Log10Binomial, MatchesSmallNumbers) {
  EXPECT_NEAR(log10_binomial(5, 2), std::log10(10), 1e-9);
  EXPECT_NEAR(log10_binomial(9, 0), 0, 1e-9);
}

TEST(Log10Chance, TakesTheMostSurprisingNumberOfMatches) {
  // n = 4: k = 2 gives log10(4 * C(4,2) * 1e-6); the third match adds nothing.
  const auto result = log10_chance({1e-4, 1e-3, 0.9}, 4);
  EXPECT_EQ(result.decisive, 2);
  EXPECT_NEAR(result.log10_chance, std::log10(4 * 6) - 6, 1e-9);
}

TEST(Log10Chance, IsZeroWithoutEvidence) {
  EXPECT_EQ(log10_chance({}, 100).log10_chance, 0);
  EXPECT_EQ(log10_chance({0.9}, 100).log10_chance, 0);
}

/// The number of false alarms must be what it says: with chance descriptors (p uniform), results
/// below 10^-1 may come in at most a tenth of the draws.
TEST(Log10Chance, IsAnUpperBoundForRandomEvidence) {
  cv::RNG random(11);
  int alarms = 0;
  constexpr int kDraws = 2000;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<double> p(60);
    for (double& value : p) value = random.uniform(1e-9, 1.0);
    std::ranges::sort(p);
    alarms += log10_chance(p, 60).log10_chance < -1;
  }
  EXPECT_LT(alarms, kDraws / 10);
}

}  // namespace
}  // namespace posevote
