#include "posevote/match/look_alikes.hpp"

#include <gtest/gtest.h>

namespace posevote {
namespace {

/// Descriptors of length 1; each number is another spot, and `seed` another picture of it.
Features spots(const std::vector<int>& numbers, int seed) {
  Features features;
  for (const int number : numbers) {
    cv::Mat spot(1, 64, CV_32F), noise(1, 64, CV_32F);
    cv::RNG(static_cast<std::uint64_t>(number) * 7919 + 1).fill(spot, cv::RNG::NORMAL, 0, 1);
    cv::RNG(static_cast<std::uint64_t>(number) * 31 + static_cast<std::uint64_t>(seed) * 977 + 5)
        .fill(noise, cv::RNG::NORMAL, 0, 0.1);
    cv::Mat descriptor = spot + noise;
    descriptor /= cv::norm(descriptor);
    features.keypoints.push_back({20.F * static_cast<float>(number % 50), 10, 2, 0, 1, 1});
    features.descriptors.push_back(descriptor);
  }
  return features;
}

std::vector<int> range(int from, int to) {
  std::vector<int> numbers;
  for (int i = from; i < to; ++i) numbers.push_back(i);
  return numbers;
}

ObjectModel object(const std::string& name, const std::vector<int>& numbers, int views = 1) {
  ObjectModel model{name, {}};
  for (int v = 0; v < views; ++v) {
    auto view = std::make_shared<View>();
    view->outline = {{0, 0}, {100, 0}, {100, 100}};
    view->features = spots(numbers, static_cast<int>(std::hash<std::string>{}(name) % 1000) + v);
    model.views.push_back(view);
  }
  return model;
}

std::vector<char> look_alikes(std::vector<ObjectModel> objects) {
  const auto models = std::make_shared<ModelSet>("surf", std::move(objects));
  return find_look_alikes(models, *make_index(models, {})).table;
}

TEST(FindLookAlikes, VariantsOfOnePackAreRelatedBothWays) {
  auto cherry = range(0, 40);
  for (const int own : range(100, 140)) cherry.push_back(own);
  const auto table = look_alikes(
      {object("mint", range(0, 80)), object("book", range(500, 580)), object("cherry", cherry)});
  EXPECT_EQ(table, (std::vector<char>{0, 0, 1, 0, 0, 0, 1, 0, 0}));
}

TEST(FindLookAlikes, ACommonLogoMakesNone) {
  auto milk = range(0, 10);
  for (const int own : range(100, 170)) milk.push_back(own);
  EXPECT_EQ(look_alikes({object("tea", range(0, 80)), object("milk", milk),
                         object("book", range(500, 580))}),
            std::vector<char>(9, 0));
}

TEST(FindLookAlikes, OneThingUnderTwoNamesIsFoundWithManyViewsAndNothingElse) {
  EXPECT_EQ(look_alikes({object("cup", range(0, 80), 6), object("mug", range(0, 80), 6)}),
            (std::vector<char>{0, 1, 1, 0}));
}

TEST(FindLookAlikes, WhatIsKnownIsKeptAndNewObjectsFindTheirPartners) {
  const ObjectModel mint = object("mint", range(0, 80)), book = object("book", range(500, 580)),
                    mug = object("mug", range(0, 80));
  const auto few = std::make_shared<ModelSet>("surf", std::vector<ObjectModel>{mint, mug});
  const LookAlikes known = find_look_alikes(few, *make_index(few, {}));
  ASSERT_EQ(known.table, (std::vector<char>{0, 1, 1, 0}));
  const auto more = std::make_shared<ModelSet>(
      "surf", std::vector<ObjectModel>{book, mug, mint, object("pad", range(500, 580))});
  EXPECT_EQ(find_look_alikes(more, *make_index(more, {}), &known).table,
            find_look_alikes(more, *make_index(more, {})).table);
  const auto without = std::make_shared<ModelSet>("surf", std::vector<ObjectModel>{mint, book});
  EXPECT_EQ(find_look_alikes(without, *make_index(without, {}), &known).table,
            std::vector<char>(4, 0));
}

TEST(FindLookAlikes, WithOneObjectOrEmptyViewsThereIsNothing) {
  EXPECT_EQ(look_alikes({object("tea", range(0, 80))}), std::vector<char>(1, 0));
  EXPECT_EQ(look_alikes({object("tea", range(0, 80)), object("plain", {})}),
            std::vector<char>(4, 0));
}

TEST(GroupViews, LookAlikesOfLookAlikesAreOneGroup) {
  const ModelSet models(
      "surf", {object("a", range(0, 2), 2), object("b", {}), object("c", {}), object("d", {})});
  const std::vector<char> table{0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 1, 0};  // a-d, d-c
  EXPECT_EQ(group_views(models, table), (std::vector<int>{0, 0, 1, 0, 0}));
  EXPECT_EQ(group_views(models, {}), (std::vector<int>{0, 0, 1, 2, 3}));
}

}  // namespace
}  // namespace posevote
