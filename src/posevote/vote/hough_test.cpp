#include "posevote/vote/hough.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace posevote {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
const cv::Size kScene(640, 480);

Keypoint point(float x, float y, float scale, float angle) {
  return {x, y, scale, angle, 1, 1};
}

/// One view of n features on a circle about (100, 100), and a scene that shows it under a
/// similarity.
struct Setting {
  Setting(int n, cv::Point2f centre, float scale, float angle) {
    auto view = std::make_shared<View>();
    view->outline = {{50, 50}, {150, 50}, {150, 150}, {50, 150}};
    view->centre = {100, 100};
    for (int i = 0; i < n; ++i) {
      const float a = 2 * kPi * static_cast<float>(i) / static_cast<float>(n);
      const float dx = 40 * std::cos(a), dy = 40 * std::sin(a);
      view->features.keypoints.push_back(point(100 + dx, 100 + dy, 2, 0.3F));
      scene.keypoints.push_back(
          point(centre.x + scale * (std::cos(angle) * dx - std::sin(angle) * dy),
                centre.y + scale * (std::sin(angle) * dx + std::cos(angle) * dy), 2 * scale,
                std::remainder(0.3F + angle, 2 * kPi)));
      matches.push_back({i, 0, i, 0.1F, 0.5F});
    }
    view->features.descriptors = cv::Mat::zeros(n, 64, CV_32F);
    models = std::make_shared<ModelSet>("surf", std::vector<ObjectModel>{{"tea", {view}}});
  }
  std::vector<PoseCluster> cluster(const VoteOptions& options) const {
    return cluster_votes(matches, scene, kScene, *models, options);
  }
  Features scene;
  std::vector<Match> matches;
  std::shared_ptr<const ModelSet> models;
};

VoteOptions paper_grid() {
  VoteOptions options;
  options.grid = "image";
  options.min_votes = 5;
  return options;
}

TEST(VoteOf, FollowsEquations1To3ForATurnByMinus90Degrees) {
  // c_o - p_o = (10, 0); twice as large; turned from 0 to -pi/2: (10, 0) -> (0, -20).
  const PoseVote vote =
      vote_of(point(200, 100, 4, -kPi / 2), point(90, 50, 2, 0), cv::Point2f(100, 50));
  EXPECT_NEAR(vote.centre.x, 200, 1e-3);
  EXPECT_NEAR(vote.centre.y, 80, 1e-3);
  EXPECT_FLOAT_EQ(vote.scale, 2);
  EXPECT_NEAR(vote.angle, -kPi / 2, 1e-6);
}

TEST(VoteOf, KeepsTheSignOfTheRotation) {
  const auto clockwise = vote_of(point(0, 0, 1, 0.5F), point(0, 0, 1, 0), {10, 0});
  const auto counter = vote_of(point(0, 0, 1, -0.5F), point(0, 0, 1, 0), {10, 0});
  EXPECT_GT(clockwise.centre.y, 0);
  EXPECT_LT(counter.centre.y, 0);
}

TEST(VoteOf, WrapsTheDifferenceOfAngles) {
  const auto vote = vote_of(point(0, 0, 1, 3), point(0, 0, 1, -3), {0, 0});
  EXPECT_NEAR(vote.angle, 6 - 2 * kPi, 1e-5);
}

class BothGrids : public testing::TestWithParam<const char*> {};

TEST_P(BothGrids, OneClusterHoldsAllMatchesOfACommonPose) {
  VoteOptions options = paper_grid();
  options.grid = GetParam();
  for (const float angle : {0.F, 1.F, kPi - 0.01F, -kPi + 0.01F}) {
    const Setting setting(8, {300, 200}, 1.3F, angle);
    const auto clusters = setting.cluster(options);
    ASSERT_FALSE(clusters.empty()) << angle;
    EXPECT_EQ(clusters[0].support, 8) << angle;
    EXPECT_NEAR(clusters[0].pose.centre.x, 300, 0.5) << angle;
    EXPECT_NEAR(clusters[0].pose.scale, 1.3, 0.01) << angle;
    EXPECT_NEAR(std::remainder(clusters[0].pose.angle - angle, 2 * kPi), 0, 0.01);
  }
}
INSTANTIATE_TEST_SUITE_P(Grids, BothGrids, testing::Values("image", "object"));

TEST(ClusterVotes, KeepsCentresOutsideThePicture) {
  const Setting setting(6, {-70, 520}, 1, 0);
  const auto clusters = setting.cluster(paper_grid());
  ASSERT_FALSE(clusters.empty());
  EXPECT_EQ(clusters[0].support, 6);
}

TEST(ClusterVotes, PutsScalesOutOfRangeInTheEndBins) {
  // 2 (n - 1) = 6 doublings: 2^-3 to 2^3 are in range.
  EXPECT_EQ(Setting(6, {300, 200}, 20, 0).cluster(paper_grid())[0].support, 6);
  EXPECT_EQ(Setting(6, {300, 200}, 0.02F, 0).cluster(paper_grid())[0].support, 6);
}

TEST(ClusterVotes, NeedsTheMinimumOfVotesAndOneLessIsNotEnough) {
  EXPECT_FALSE(Setting(5, {300, 200}, 1, 0).cluster(paper_grid()).empty());
  EXPECT_TRUE(Setting(4, {300, 200}, 1, 0).cluster(paper_grid()).empty());
}

TEST(ClusterVotes, CountsASceneFeatureOnce) {
  Setting setting(5, {300, 200}, 1, 0);
  for (Match& match : setting.matches) match.scene = 0;
  EXPECT_TRUE(setting.cluster(paper_grid()).empty());
}

TEST(ClusterVotes, ScatteredVotesMakeNoCluster) {
  Setting setting(8, {300, 200}, 1, 0);
  for (std::size_t i = 0; i < 8; ++i)
    setting.scene.keypoints[i].angle = std::remainder(0.78F * static_cast<float>(i), 2 * kPi);
  EXPECT_TRUE(setting.cluster(paper_grid()).empty());
}

TEST(ClusterVotes, NoMatchesGiveNoClusters) {
  EXPECT_TRUE(Setting(0, {0, 0}, 1, 0).cluster(paper_grid()).empty());
}

}  // namespace
}  // namespace posevote
