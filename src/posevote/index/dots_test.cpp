#include "posevote/index/dots.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>
#ifdef POSEVOTE_WITH_HIGHWAY
#include <hwy/targets.h>
#endif

namespace posevote {
namespace {

/// Runs `test` once with each instruction set that this build and this CPU have.
template <class Test>
void for_each_target(const Test& test) {
#ifdef POSEVOTE_WITH_HIGHWAY
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    test();
    hwy::SetSupportedTargetsForTest(0);
  }
#else
  test();
#endif
}

struct Problem {
  std::size_t blocks, quads;
  std::vector<std::uint8_t> codes;
  std::vector<std::vector<std::int8_t>> queries;

  [[nodiscard]] QueryGroup group(std::size_t count) const {
    QueryGroup result{};
    for (std::size_t q = 0; q < count; ++q) result.codes[q] = queries[q].data();
    result.count = count;
    return result;
  }
};

Problem random_problem(std::size_t blocks, std::size_t quads) {
  std::mt19937 random(7);
  Problem problem{blocks, quads, {}, {}};
  problem.codes.resize(blocks * quads * kBlockLanes * 4);
  for (auto& code : problem.codes) code = static_cast<std::uint8_t>(random() % 256);
  for (std::size_t q = 0; q < kMaxQueries; ++q) {
    problem.queries.emplace_back(quads * 4);
    for (auto& value : problem.queries.back())
      value = static_cast<std::int8_t>(static_cast<int>(random() % 129) - 64);
  }
  return problem;
}

void expect_scalar_products(const Problem& problem, std::size_t count) {
  const std::size_t stride = problem.blocks * kBlockLanes + 5;
  std::vector<std::int16_t> expected(count * stride, 99);
  std::vector<std::int16_t> found = expected;
  scalar::dots(problem.codes.data(), problem.blocks, problem.quads, problem.group(count),
               expected.data(), stride);
  dots(problem.codes.data(), problem.blocks, problem.quads, problem.group(count), found.data(),
       stride);
  EXPECT_EQ(found, expected) << count << " queries, " << problem.quads << " quads";
}

TEST(Dots, AgreeWithScalarCodeOnEveryTarget) {
  for_each_target([] {
    for (const std::size_t quads : {1, 2, 3, 16, 32, 33})
      for (std::size_t count = 1; count <= kMaxQueries; ++count)
        expect_scalar_products(random_problem(3, quads), count);
  });
}

TEST(Dots, DoNotSaturateAtTheLargestPairsAllowed) {
  for_each_target([] {
    for (const int large : {127, 64, -127, -64}) {
      Problem problem = random_problem(1, 16);
      for (auto& query : problem.queries)
        for (std::size_t d = 0; d < query.size(); d += 2) {
          query[d] = static_cast<std::int8_t>(large);
          query[d + 1] = static_cast<std::int8_t>(large > 0 ? 128 - large : -128 - large);
        }
      problem.codes.assign(problem.codes.size(), 255);
      expect_scalar_products(problem, 4);
      problem.codes.assign(problem.codes.size(), 0);
      expect_scalar_products(problem, 4);
    }
  });
}

TEST(Dots, OfNoBlocksWriteNothing) {
  for_each_target([] { expect_scalar_products(random_problem(0, 16), 2); });
}

TEST(FindAtLeast, AgreesWithScalarCodeOnEveryTarget) {
  std::mt19937 random(3);
  std::vector<std::int16_t> values(160);
  for (auto& value : values) value = static_cast<std::int16_t>(random() % 65536 - 32768);
  values[0] = 32767;
  values[159] = -32768;
  for_each_target([&] {
    for (const int limit : {-32768, -100, 0, 30000, 32767}) {
      std::vector<std::uint32_t> expected(values.size()), found(values.size());
      const auto l = static_cast<std::int16_t>(limit);
      const std::size_t n = scalar::find_at_least(values.data(), 160, l, expected.data());
      EXPECT_EQ(find_at_least(values.data(), 160, l, found.data()), n);
      EXPECT_EQ(found, expected);
    }
    EXPECT_EQ(find_at_least(values.data(), 0, 0, nullptr), 0U);
  });
}

TEST(BlockMaxima, AgreeWithScalarCodeOnEveryTarget) {
  std::mt19937 random(4);
  std::vector<std::int16_t> values(320);
  for (auto& value : values) value = static_cast<std::int16_t>(random() % 65536 - 32768);
  for_each_target([&] {
    std::vector<std::int16_t> expected(20), found(20);
    scalar::block_maxima(values.data(), values.size(), expected.data());
    block_maxima(values.data(), values.size(), found.data());
    EXPECT_EQ(found, expected);
  });
}

}  // namespace
}  // namespace posevote
