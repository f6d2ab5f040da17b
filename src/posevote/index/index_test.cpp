#include "posevote/index/index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "posevote/core/error.hpp"
#include "posevote/index/each_target.hpp"

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
void expect_same(const NeighborLists& found, const std::vector<std::vector<Neighbor>>& expected) {
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

/// The contract of Index::search_rivals: `lists` up to their first of another group.
std::vector<std::vector<Neighbor>> up_to_rival(std::vector<std::vector<Neighbor>> lists,
                                               const std::vector<int>& groups) {
  const auto group = [&](const Neighbor& n) {
    return n.view < 0 ? -1 : groups[static_cast<std::size_t>(n.view)];
  };
  for (auto& list : lists) {
    const auto rival = std::ranges::find_if(
        list, [&](const Neighbor& n) { return group(n) != group(list.front()); });
    if (rival != list.end()) list.erase(rival + 1, list.end());
  }
  return lists;
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
  for (const int k : {1, 2, 17, 1000}) {
    const auto expected = oracle(*models, scene, k);
    for_each_target([&] { expect_same(make_index(models, exact())->search(scene, k), expected); });
  }
}

TEST(ExactIndex, FindsTheNeighboursUpToARival) {
  const auto models =
      make_models({make_view(random_features(200, 64, 1)), make_view(random_features(150, 64, 2)),
                   make_view(random_features(97, 64, 3, {1, -1, 0}))},
                  {random_features(40, 64, 4)});
  const Features scene = random_features(60, 64, 6, {0, 1, -1});
  for (const auto& groups : std::vector<std::vector<int>>{{0, 1, 2}, {0, 0, 1}, {5, 5, 5}})
    for (const int k : {1, 2, 17, 1000}) {
      const auto expected = up_to_rival(oracle(*models, scene, k), groups);
      for_each_target([&] {
        expect_same(make_index(models, exact())->search_rivals(scene, k, groups), expected);
      });
    }
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
  EXPECT_EQ(make_index(models, exact())->search(Features(), 3).size(), 0U);
  EXPECT_TRUE(make_index(models, exact())->search(scene, 0)[0].empty());
}

TEST(ExactIndex, RefusesDescriptorsOfAnotherLength) {
  const auto models = make_models({make_view(random_features(10, 64, 1))});
  EXPECT_THROW((void)make_index(models, exact())->search(random_features(4, 128, 1), 3), Error);
}

TEST(ExactIndex, TakesHalfFloatsAndExtremeDescriptors) {
  Features pool = random_features(50, 64, 1, {0});
  for (int i = 0; i < 10; ++i) {  // one value holds everything, or all values are equal
    pool.descriptors.row(i).setTo(i % 2 == 0 ? 0.125 : 0);
    if (i % 2 != 0) pool.descriptors.at<float>(i, i) = i % 3 == 0 ? -1.0F : 1.0F;
  }
  const Features scene = pool;
  pool.descriptors.convertTo(pool.descriptors, CV_16F);
  const auto found = make_index(make_models({}, {pool}), exact())->search(scene, 1);
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].size(), 1U);
    EXPECT_LT(found[i][0].distance, 1e-3);
  }
}

TEST(ExactIndex, SurvivesValuesThatAreNotNumbers) {
  Features broken = random_features(40, 64, 1);
  broken.descriptors.row(3).setTo(std::numeric_limits<float>::quiet_NaN());
  broken.descriptors.row(4).setTo(std::numeric_limits<float>::infinity());
  broken.descriptors.row(5).setTo(1e30);
  const auto models = make_models({make_view(broken)});
  for (const char* method : {"exact", "approximate"}) {
    IndexOptions options;
    options.method = method;
    EXPECT_EQ(make_index(models, options)->search(broken, 3).size(), 40U);
  }
}

/// Views whose descriptors gather about some common directions, as real ones do.
std::vector<std::shared_ptr<const View>> clustered_views(int views, int rows, int dimension = 64) {
  const Features directions = random_features(200, dimension, 77);
  std::vector<std::shared_ptr<const View>> result;
  cv::RNG random(5);
  for (int v = 0; v < views; ++v) {
    Features features = random_features(rows, dimension, 100 + v, {1, -1});
    for (int i = 0; i < rows; ++i) {
      cv::Mat row = features.descriptors.row(i);
      row = 0.6 * row + directions.descriptors.row(random.uniform(0, 200));
      cv::normalize(row, row);
    }
    result.push_back(make_view(features));
  }
  return result;
}

/// The scene sees features of some views again, a little changed.
Features seen_again(const std::vector<std::shared_ptr<const View>>& views) {
  Features scene;
  for (std::size_t v = 0; v < views.size(); v += 3) {
    const Features& features = views[v]->features;
    const Features noise = random_features(20, features.descriptors.cols, int(v));
    for (int i = 0; i < 20; ++i) {
      cv::Mat row = features.descriptors.row(i) + 0.25 * noise.descriptors.row(i);
      cv::normalize(row, row);
      scene.descriptors.push_back(row);
      scene.keypoints.push_back(features.keypoints[static_cast<std::size_t>(i)]);
    }
  }
  return scene;
}

IndexOptions approximate() {
  IndexOptions options;
  options.method = "approximate";
  return options;
}

/// Share of the first neighbours that are the right ones.
double recall_first(const NeighborLists& found, const NeighborLists& expected) {
  double right = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    right += found[i].size() == expected[i].size() && found[i][0].view == expected[i][0].view &&
             found[i][0].feature == expected[i][0].feature;
  return right / static_cast<double>(found.size());
}

void expect_equal(const NeighborLists& a, const NeighborLists& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].size(), b[i].size());
    for (std::size_t j = 0; j < a[i].size(); ++j) {
      EXPECT_EQ(a[i][j].view, b[i][j].view);
      EXPECT_EQ(a[i][j].feature, b[i][j].feature);
      EXPECT_EQ(a[i][j].distance, b[i][j].distance);
    }
  }
}

TEST(ApproximateIndex, FindsNearlyAllFirstNeighbours) {
  for (const int dimension : {64, 128}) {
    const auto views = clustered_views(60, 200, dimension);
    const auto models = make_models(views);
    const Features scene = seen_again(views);
    const auto index = make_index(models, approximate());
    EXPECT_GT(index->statistics().lists, 100U);
    const auto found = index->search(scene, 10);
    EXPECT_GE(recall_first(found, make_index(models, exact())->search(scene, 10)), 0.98);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Neighbor& n = found[i][0];
      EXPECT_NEAR(
          n.distance,
          distance(scene.descriptors, int(i),
                   models->views()[std::size_t(n.view)].view->features.descriptors, n.feature),
          2e-6);
    }
  }
}

TEST(ApproximateIndex, FindsNearlyAllRivals) {
  const auto views = clustered_views(60, 200);
  const auto models = make_models(views);
  const Features scene = seen_again(views);
  std::vector<int> groups;
  groups.reserve(60);
  for (int v = 0; v < 60; ++v) groups.push_back(v / 6);
  const auto found = make_index(models, approximate())->search_rivals(scene, 24, groups);
  const auto expected = make_index(models, exact())->search_rivals(scene, 24, groups);
  double same_first = 0, same_end = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    same_first += found[i].front().distance == expected[i].front().distance ? 1 : 0;
    same_end += found[i].back().distance == expected[i].back().distance ? 1 : 0;
  }
  EXPECT_GE(same_first / static_cast<double>(found.size()), 0.95);
  EXPECT_GE(same_end / static_cast<double>(found.size()), 0.9);
}

TEST(ApproximateIndex, AnswersTheSameOnEveryTarget) {
  const auto views = clustered_views(30, 100);
  const auto models = make_models(views);
  const Features scene = seen_again(views);
  const auto expected = make_index(models, approximate())->search(scene, 10);
  for_each_target(
      [&] { expect_equal(make_index(models, approximate())->search(scene, 10), expected); });
}

TEST(ApproximateIndex, AnswersTheSameForEachRowAlone) {
  const auto views = clustered_views(30, 100);
  const auto index = make_index(make_models(views), approximate());
  const Features scene = seen_again(views);
  const auto together = index->search(scene, 10);
  for (std::size_t i = 0; i < scene.size(); i += 13) {
    const auto row = static_cast<int>(i);
    const Features one{{scene.keypoints[i]}, scene.descriptors.rowRange(row, row + 1)};
    const auto alone = index->search(one, 10);
    ASSERT_EQ(alone[0].size(), together[i].size());
    for (std::size_t j = 0; j < alone[0].size(); ++j)
      EXPECT_EQ(alone[0][j].feature, together[i][j].feature);
  }
}

TEST(ApproximateIndex, IsExactWhenItProbesEveryList) {
  const auto views = clustered_views(20, 200);
  const auto models = make_models(views);
  IndexOptions options = approximate();
  options.probes = 65536;
  const Features scene = seen_again(views);
  EXPECT_EQ(recall_first(make_index(models, options)->search(scene, 5),
                         make_index(models, exact())->search(scene, 5)),
            1.0);
}

TEST(ApproximateIndex, AnswersTheSameForAnyNumberOfThreads) {
  const auto views = clustered_views(40, 150);
  const auto models = make_models(views);
  const Features scene = seen_again(views);
  IndexOptions options = approximate();
  const auto one = make_index(models, options)->search(scene, 10);
  for (const int threads : {2, 3, 64, 256}) {
    options.threads = threads;
    expect_equal(make_index(models, options)->search(scene, 10), one);
  }
}

TEST(ApproximateIndex, NeverPairsOppositeSigns) {
  const auto views = clustered_views(30, 100);
  const auto models = make_models(views);
  Features scene = seen_again(views);
  const auto index = make_index(models, approximate());
  const auto found = index->search(scene, 20);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const Neighbor& n : found[i])
      EXPECT_EQ(views[std::size_t(n.view)]->features.keypoints[std::size_t(n.feature)].laplacian,
                scene.keypoints[i].laplacian);
}

TEST(GrowingIndex, KnowsAddedAndForgetsRemovedViews) {
  const auto views = clustered_views(60, 100);
  const Features pool = random_features(50, 64, 9);
  for (const IndexOptions& options : {exact(), approximate()}) {
    std::shared_ptr<const Index> index;
    // Views come one by one, later the first ones go, some in the middle, and come back.
    std::vector<std::pair<std::size_t, std::size_t>> ranges;
    for (std::size_t n = 1; n <= 60; n += 7) ranges.emplace_back(0, n);
    for (const auto& range : {std::pair<std::size_t, std::size_t>{20, 57}, {50, 60}, {0, 60}})
      ranges.push_back(range);
    for (const auto& [first, last] : ranges) {
      const auto models =
          make_models({views.begin() + int(first), views.begin() + int(last)}, {pool});
      index = make_index(models, options, index.get());
      EXPECT_EQ(index->statistics().descriptors, models->feature_count() + pool.size());
      const Features scene = seen_again({views.begin() + int(first), views.begin() + int(last)});
      const auto fresh = make_index(models, exact())->search(scene, 4);
      const auto found = index->search(scene, 4);
      if (options.method == "exact")
        expect_equal(found, fresh);
      else
        EXPECT_GE(recall_first(found, fresh), 0.98) << first << " - " << last;
    }
  }
}

TEST(GrowingIndex, SharesWhatItHasPrepared) {
  const auto views = clustered_views(60, 100);
  const auto before = make_index(make_models({views.begin(), views.end() - 1}), approximate());
  const auto after = make_index(make_models(views), approximate(), before.get());
  EXPECT_EQ(before->statistics().segments, 1U);
  EXPECT_EQ(after->statistics().segments, 2U);
  EXPECT_EQ(after->statistics().assigned, 100U);
}

TEST(GrowingIndex, FindsTheSameViewInTwoObjects) {
  const auto view = make_view(random_features(10, 64, 1, {1}));
  const auto before = make_index(make_models({view}), exact());
  const auto after = make_index(make_models({view, view}), exact(), before.get());
  const auto found = after->search(random_features(1, 64, 1, {1}), 2);
  EXPECT_EQ(found[0][0].view, 0);
  EXPECT_EQ(found[0][1].view, 1);
}

TEST(SavedIndex, AnswersAsBefore) {
  const auto views = clustered_views(50, 100);
  const auto models = make_models(views, {random_features(30, 64, 9)});
  const auto index = make_index(models, approximate());
  const auto loaded = load_index(models, index->save(), approximate());
  const Features scene = seen_again(views);
  expect_equal(loaded->search(scene, 5), index->search(scene, 5));
  EXPECT_EQ(loaded->save(), index->save());
  EXPECT_EQ(index->statistics().assigned, models->feature_count() + 30);
  EXPECT_EQ(loaded->statistics().assigned, 0U);
}

TEST(SavedIndex, TakesAnOlderStateOfTheModels) {
  const auto views = clustered_views(50, 100);
  const auto old = make_index(make_models({views.begin() + 5, views.end() - 5}), approximate());
  const auto models = make_models(views);
  const Features scene = seen_again(views);
  EXPECT_GE(recall_first(load_index(models, old->save(), approximate())->search(scene, 5),
                         make_index(models, exact())->search(scene, 5)),
            0.98);
}

TEST(SavedIndex, IgnoresBytesThatAreOfNoUse) {
  const auto views = clustered_views(20, 100);
  const auto models = make_models(views);
  const Features scene = seen_again(views);
  const auto index = make_index(models, approximate());
  const auto expected = index->search(scene, 5);
  const std::string good = index->save();
  for (std::size_t i = 0; i < good.size(); i += 97) {
    std::string damaged = good;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    if (i % 3 == 0) damaged.resize(i);
    if (i > 3000 && i % 13 != 0) continue;
    expect_equal(load_index(models, damaged, approximate())->search(scene, 5), expected);
  }
  const auto other = make_index(make_models(clustered_views(20, 100, 128)), approximate());
  expect_equal(load_index(models, other->save(), approximate())->search(scene, 5), expected);
}

}  // namespace
}  // namespace posevote
