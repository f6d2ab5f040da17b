#include "posevote/verify/scene_context.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace posevote {
namespace {

Features random_features(int count, cv::RNG& random) {
  Features features;
  features.keypoints.resize(static_cast<std::size_t>(count));
  features.descriptors.create(count, 64, CV_32F);
  random.fill(features.descriptors, cv::RNG::NORMAL, 0, 1);
  for (int i = 0; i < count; ++i)
    cv::normalize(features.descriptors.row(i), features.descriptors.row(i));
  return features;
}

/// The rank-th smallest distance to the first 1000 scene features, or the largest.
double nth_of_all(const cv::Mat& taught, const Features& scene, int rank) {
  std::vector<double> distances;
  for (int s = 0; s < std::min(1000, scene.descriptors.rows); ++s)
    distances.push_back(cv::norm(taught, scene.descriptors.row(s)));
  std::ranges::sort(distances);
  return distances[std::min(static_cast<std::size_t>(rank), distances.size()) - 1];
}

class SceneRivalsOf : public testing::TestWithParam<int> {};

TEST_P(SceneRivalsOf, AreAsFarAsALoopOverAllSays) {
  constexpr int kRank = 8;
  cv::RNG random(5);
  const auto view = std::make_shared<View>();
  view->outline = {{0, 0}, {9, 0}, {0, 9}};
  view->features = random_features(200, random);
  const ModelSet models("surf", {{"thing", {view}}});
  const Features scene = random_features(GetParam(), random);
  SceneRivals rivals(models, scene, kRank);
  for (int feature = 0; feature < 200; ++feature) {
    const Reference found = rivals.reference(0, feature);
    EXPECT_NEAR(found.distance, nth_of_all(view->features.descriptors.row(feature), scene, kRank),
                1e-5);
    const double count = std::min(1000, GetParam());
    EXPECT_DOUBLE_EQ(found.rate, std::min<double>(kRank, count) / count);
  }
}

INSTANTIATE_TEST_SUITE_P(Features, SceneRivalsOf, testing::Values(1, 3, 8, 9, 17, 33, 1000, 1500));

TEST(SceneRivals, BearASceneWithoutFeatures) {
  const ModelSet models("surf", {});
  const SceneRivals rivals(models, {}, 8);
}

}  // namespace
}  // namespace posevote
