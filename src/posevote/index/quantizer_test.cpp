#include "posevote/index/quantizer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace posevote {
namespace {

constexpr int kDimension = 16;

/// Unit rows about `groups` directions, in turn.
std::vector<std::vector<float>> grouped_rows(std::size_t count, std::size_t groups) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  std::vector<std::vector<float>> directions, rows;
  const auto draw = [&](float size) {
    std::vector<float> row(kDimension);
    for (float& v : row) v = size * normal(random);
    return row;
  };
  for (std::size_t g = 0; g < groups; ++g) directions.push_back(draw(1));
  for (std::size_t i = 0; i < count; ++i) {
    rows.push_back(draw(0.1F));
    for (std::size_t d = 0; d < kDimension; ++d) rows[i][d] += directions[i % groups][d];
    const float length = std::sqrt(product(rows[i].data(), rows[i].data(), kDimension));
    for (float& v : rows[i]) v /= length;
  }
  return rows;
}

Centers::ReadRow reader(const std::vector<std::vector<float>>& rows) {
  return [&rows](std::size_t i, std::vector<float>&) { return rows[i].data(); };
}

TEST(Centers, KeepGroupsTogetherAndApart) {
  const Coder coder(kDimension);
  const auto rows = grouped_rows(300, 7);
  const Centers centers = Centers::train(coder, 7, rows.size(), reader(rows), 1);
  std::vector<std::uint16_t> lists(rows.size());
  centers.assign(coder, rows.size(), reader(rows), lists.data(), 1);
  for (std::size_t i = 7; i < rows.size(); ++i) EXPECT_EQ(lists[i], lists[i % 7]);
  EXPECT_GE(std::set<int>(lists.begin(), lists.end()).size(), 5U);
}

TEST(Centers, AssignTheSameWithAnyNumberOfThreads) {
  const Coder coder(kDimension);
  const auto rows = grouped_rows(301, 50);
  const Centers one = Centers::train(coder, 40, rows.size(), reader(rows), 1);
  const Centers many = Centers::train(coder, 40, rows.size(), reader(rows), 5);
  EXPECT_EQ(one.codes(), many.codes());
  EXPECT_EQ(one.member_scale(), many.member_scale());
}

TEST(Centers, NameTheNearestListsFirstOfAll) {
  const Coder coder(kDimension);
  const auto rows = grouped_rows(400, 100);
  const Centers centers = Centers::train(coder, 90, rows.size(), reader(rows), 1);
  Centers::Buffer buffer;
  for (const std::size_t probes : {1, 3, 40, 90, 1000}) {
    const std::size_t expected = std::min<std::size_t>(probes, 90);
    for (std::size_t i = 0; i < rows.size(); i += 37) {
      std::vector<std::int8_t> code(coder.quads() * 4);
      coder.encode_query(rows[i].data(), code.data());
      std::vector<Centers::Probe> found(expected);
      centers.nearest(coder, {{code.data()}, 1}, probes, buffer, found.data());
      std::vector<std::uint16_t> lists;
      lists.reserve(found.size());
      for (const Centers::Probe& probe : found) lists.push_back(probe.list);
      EXPECT_TRUE(std::is_sorted(lists.begin() + 1, lists.end()));
      for (const Centers::Probe& probe : found) EXPECT_LE(probe.product, found[0].product);
      const auto near = [&](std::size_t list) {
        return product(rows[i].data(), centers.center(list), kDimension);
      };
      float worst = 2;
      for (const auto list : lists) worst = std::min(worst, near(list));
      const std::set<std::size_t> chosen(lists.begin(), lists.end());
      EXPECT_EQ(chosen.size(), expected);
      for (std::size_t l = 0; l < 90; ++l) {
        EXPECT_LE(near(l), near(lists[0]) + 0.02F);
        EXPECT_TRUE(chosen.count(l) == 1 || near(l) <= worst + 0.02F);
      }
    }
  }
}

TEST(Centers, NameEquallyNearListsOnce) {
  const Coder coder(kDimension);
  const auto one = grouped_rows(1, 1);
  const std::vector<std::vector<float>> rows(40, one[0]);
  const Centers centers = Centers::train(coder, 20, rows.size(), reader(rows), 1);
  std::vector<std::int8_t> code(coder.quads() * 4);
  coder.encode_query(rows[0].data(), code.data());
  Centers::Buffer buffer;
  std::vector<Centers::Probe> found(7);
  centers.nearest(coder, {{code.data()}, 1}, 7, buffer, found.data());
  for (std::uint16_t i = 0; i < 7; ++i) EXPECT_EQ(found[i].list, i);
}

TEST(Centers, WithoutTrainingAreOneList) {
  const Coder coder(kDimension);
  const Centers centers;
  EXPECT_EQ(centers.lists(), 1U);
  EXPECT_EQ(centers.center(0), nullptr);
  const auto rows = grouped_rows(5, 5);
  std::vector<std::uint16_t> lists(5, 9);
  centers.assign(coder, 5, reader(rows), lists.data(), 1);
  EXPECT_EQ(lists, std::vector<std::uint16_t>(5, 0));
}

TEST(Centers, ComeBackFromTheirCodes) {
  const Coder coder(kDimension);
  const auto rows = grouped_rows(200, 20);
  const Centers centers = Centers::train(coder, 20, rows.size(), reader(rows), 1);
  const Centers again(coder, centers.count(), centers.codes(), centers.member_scale());
  std::vector<std::uint16_t> a(200), b(200);
  centers.assign(coder, 200, reader(rows), a.data(), 1);
  again.assign(coder, 200, reader(rows), b.data(), 1);
  EXPECT_EQ(a, b);
  EXPECT_EQ(centers.center(7)[3], again.center(7)[3]);
}

}  // namespace
}  // namespace posevote
