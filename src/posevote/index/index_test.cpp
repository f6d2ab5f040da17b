#include "posevote/index/index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

/// `count` random rows of length 1 with Laplacian signs from `signs`, in turn.
Features random_features(int count, int dimension, int seed,
                         const std::vector<int>& signs = {1, -1}) {
  Features features;
  if (count == 0) return features;
  features.keypoints.resize(static_cast<std::size_t>(count));
  features.descriptors.create(count, dimension, CV_32F);
  cv::RNG random(static_cast<std::uint64_t>(seed));
  random.fill(features.descriptors, cv::RNG::NORMAL, 0, 1);
  for (int i = 0; i < count; ++i) {
    cv::normalize(features.descriptors.row(i), features.descriptors.row(i));
    features.keypoints[static_cast<std::size_t>(i)].laplacian =
        static_cast<std::int8_t>(signs[static_cast<std::size_t>(i) % signs.size()]);
  }
  return features;
}

std::shared_ptr<const View> make_view(Features features) {
  auto view = std::make_shared<View>();
  view->outline = {{0, 0}, {10, 0}, {10, 10}};
  view->features = std::move(features);
  return view;
}

std::shared_ptr<const ModelSet> make_models(const std::vector<std::shared_ptr<const View>>& views,
                                            std::vector<Features> impostors = {}) {
  std::vector<ObjectModel> objects;
  for (std::size_t i = 0; i < views.size(); ++i)
    objects.push_back({"object " + std::to_string(i), {views[i]}});
  return std::make_shared<ModelSet>("test", std::move(objects), std::move(impostors));
}

double distance(const cv::Mat& a, int i, const cv::Mat& b, int j) {
  double sum = 0;
  for (int d = 0; d < a.cols; ++d)
    sum += std::pow(double(a.at<float>(i, d)) - double(b.at<float>(j, d)), 2);
  return std::sqrt(sum);
}

/// The contract of Index::search in its plainest form.
std::vector<std::vector<Neighbor>> oracle(const ModelSet& models, const Features& scene, int k) {
  std::vector<std::vector<Neighbor>> result;
  for (int i = 0; i < static_cast<int>(scene.size()); ++i) {
    using Key = std::tuple<double, int, int>;
    std::vector<Key> all;
    const auto add = [&](const Features& features, int view, int first) {
      for (int j = 0; j < static_cast<int>(features.size()); ++j)
        if (scene.keypoints[std::size_t(i)].laplacian *
                features.keypoints[std::size_t(j)].laplacian >=
            0)
          all.emplace_back(distance(scene.descriptors, i, features.descriptors, j), view,
                           first + j);
    };
    for (std::size_t v = 0; v < models.views().size(); ++v)
      add(models.views()[v].view->features, static_cast<int>(v), 0);
    int counted = 0;
    for (const Features& pool : models.impostors()) {
      add(pool, std::numeric_limits<int>::max(), counted);
      counted += static_cast<int>(pool.size());
    }
    std::sort(all.begin(), all.end());
    all.resize(std::min(all.size(), static_cast<std::size_t>(k)));
    std::vector<Neighbor>& row = result.emplace_back();
    for (const auto& [d, view, feature] : all)
      row.push_back(
          {view == std::numeric_limits<int>::max() ? -1 : view, feature, static_cast<float>(d)});
  }
  return result;
}

/// Places may differ only where two distances agree to the rounding of floats.
void expect_same(const std::vector<std::vector<Neighbor>>& found,
                 const std::vector<std::vector<Neighbor>>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  constexpr float kRounding = 2e-6F;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].size(), expected[i].size()) << "query " << i;
    const auto tied = [&](std::size_t j, std::size_t other) {
      return other < expected[i].size() &&
             std::abs(expected[i][j].distance - expected[i][other].distance) < kRounding;
    };
    for (std::size_t j = 0; j < found[i].size(); ++j) {
      EXPECT_NEAR(found[i][j].distance, expected[i][j].distance, kRounding);
      if (tied(j, j + 1) || tied(j, j - 1)) continue;
      EXPECT_EQ(found[i][j].view, expected[i][j].view) << "query " << i << " neighbour " << j;
      EXPECT_EQ(found[i][j].feature, expected[i][j].feature) << "query " << i << " neighbour " << j;
    }
  }
}

IndexOptions exact() {
  IndexOptions options;
  options.method = "exact";
  return options;
}

TEST(ExactIndex, FindsTheNeighboursOfTheOracle) {
  const auto models =
      make_models({make_view(random_features(333, 64, 1)), make_view(random_features(0, 64, 2)),
                   make_view(random_features(97, 64, 3, {1, -1, 0}))},
                  {random_features(20, 64, 4), random_features(31, 64, 5)});
  const Features scene = random_features(60, 64, 6, {0, 1, -1});
  for (const int k : {1, 2, 17, 1000})
    expect_same(make_index(models, exact())->search(scene, k), oracle(*models, scene, k));
}

TEST(ExactIndex, WorksForOtherLengths) {
  for (const int dimension : {1, 3, 36, 128, 129}) {
    const auto models = make_models({make_view(random_features(100, dimension, 1, {0}))});
    const Features scene = random_features(10, dimension, 2, {0});
    if (dimension > 1)
      expect_same(make_index(models, exact())->search(scene, 5), oracle(*models, scene, 5));
    else
      EXPECT_EQ(make_index(models, exact())->search(scene, 5).size(), 10U);
  }
}

TEST(ExactIndex, OrdersEqualDistancesByViewThenFeatureThenPool) {
  const Features one = random_features(1, 64, 1, {1});
  Features twice = one;
  twice.keypoints.resize(2, one.keypoints[0]);
  cv::vconcat(one.descriptors, one.descriptors, twice.descriptors);
  const auto models = make_models({make_view(twice), make_view(one)}, {one});
  const auto found = make_index(models, exact())->search(one, 9);
  ASSERT_EQ(found.size(), 1U);
  std::vector<std::pair<int, int>> places;
  for (const Neighbor& n : found[0]) places.emplace_back(n.view, n.feature);
  EXPECT_EQ(places, (std::vector<std::pair<int, int>>{{0, 0}, {0, 1}, {1, 0}, {-1, 0}}));
  const auto two = make_index(models, exact())->search(one, 2);
  EXPECT_EQ(two[0][1].feature, 1);
}

TEST(ExactIndex, NeverPairsOppositeSigns) {
  const auto models = make_models({make_view(random_features(10, 64, 1, {1}))});
  EXPECT_TRUE(make_index(models, exact())->search(random_features(1, 64, 1, {-1}), 3)[0].empty());
  EXPECT_EQ(make_index(models, exact())->search(random_features(1, 64, 1, {0}), 3)[0].size(), 3U);
}

TEST(ExactIndex, AnswersNothingFromNothing) {
  const Features scene = random_features(4, 64, 1);
  EXPECT_EQ(make_index(make_models({}), exact())->search(scene, 3).size(), 4U);
  EXPECT_TRUE(make_index(make_models({}), exact())->search(scene, 3)[0].empty());
  const auto models = make_models({make_view(random_features(10, 64, 1))});
  EXPECT_TRUE(make_index(models, exact())->search(Features(), 3).empty());
  EXPECT_TRUE(make_index(models, exact())->search(scene, 0)[0].empty());
}

TEST(ExactIndex, RefusesDescriptorsOfAnotherLength) {
  const auto models = make_models({make_view(random_features(10, 64, 1))});
  EXPECT_THROW((void)make_index(models, exact())->search(random_features(4, 128, 1), 3), Error);
}

}  // namespace
}  // namespace posevote
