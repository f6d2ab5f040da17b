#include "posevote/index/dots.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "posevote/index/each_target.hpp"

namespace posevote {
namespace {

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

TEST(KthLargest, AgreesWithScalarCodeOnEveryTarget) {
  std::mt19937 random(4);
  for (const int range : {65536, 7, 1}) {
    std::vector<std::int16_t> values(320);
    for (auto& value : values)
      value = static_cast<std::int16_t>(static_cast<int>(random()) % range - (range > 9 ? 0 : 3));
    if (range > 9) values[17] = 32767;
    if (range > 9) values[18] = -32768;
    for_each_target([&] {
      for (const std::size_t count : {16, 48, 320})
        for (std::size_t k = 1; k <= count; k += k < 5 ? 1 : 7)
          EXPECT_EQ(kth_largest(values.data(), count, k),
                    scalar::kth_largest(values.data(), count, k))
              << "the " << k << "th of " << count;
    });
  }
}

TEST(KthLargest, CountsBeyondSixteenBits) {
  std::vector<std::int16_t> values(80000, 5);
  for (std::size_t i = 0; i < 40000; ++i) values[2 * i] = 6;
  for_each_target([&] {
    EXPECT_EQ(kth_largest(values.data(), values.size(), 40000), 6);
    EXPECT_EQ(kth_largest(values.data(), values.size(), 40001), 5);
  });
}

TEST(Scan, AgreesWithScalarCodeOnEveryTarget) {
  const Problem problem = random_problem(5, 16);
  constexpr std::size_t kBlocks = 5;
  struct Answer {
    std::vector<std::int16_t> products = std::vector<std::int16_t>(kBlocks * kBlockLanes);
    std::vector<std::uint16_t> found = std::vector<std::uint16_t>(kBlocks, std::uint16_t{9});
  };
  const auto queries = [&](std::vector<Answer>& answers) {
    std::vector<ScanQuery> result;
    for (std::size_t q = 0; q < answers.size(); ++q) {
      std::int32_t offset = 0;
      for (const std::int8_t value : problem.queries[q % kMaxQueries]) offset += 128 * value;
      const auto limit = static_cast<std::int16_t>(q == 3 ? -32768 : 1000 * static_cast<int>(q));
      result.push_back({problem.queries[q % kMaxQueries].data(), offset, limit,
                        answers[q].products.data(), answers[q].found.data()});
    }
    return result;
  };
  for_each_target([&] {
    for (std::size_t count = 0; count <= 9; ++count) {
      std::vector<Answer> expected(count), found(count);
      const std::uint32_t some =
          scalar::scan(problem.codes.data(), kBlocks, 16, queries(expected).data(), count);
      EXPECT_EQ(scan(problem.codes.data(), kBlocks, 16, queries(found).data(), count), some);
      for (std::size_t q = 0; q < count; ++q) {
        EXPECT_EQ(some >> q & 1U,
                  std::ranges::any_of(expected[q].found, std::identity()) ? 1U : 0U);
        for (std::size_t i = 0; i < expected[q].products.size(); ++i) {
          if (expected[q].found[i / kBlockLanes] == 0) continue;
          EXPECT_EQ(found[q].products[i], expected[q].products[i]) << q << " of " << count;
        }
        EXPECT_EQ(found[q].found, expected[q].found) << q << " of " << count;
      }
    }
  });
}

TEST(Scan, FindsProductsAtTheLimitOnly) {
  const Problem problem = random_problem(1, 4);
  std::int16_t products[kBlockLanes];
  dots(problem.codes.data(), 1, 4, problem.group(1), products, kBlockLanes);
  std::int32_t offset = 0;
  for (const std::int8_t value : problem.queries[0]) offset += 128 * value;
  const std::int16_t largest = *std::max_element(products, products + kBlockLanes);
  for_each_target([&] {
    for (const int more : {0, 1}) {
      std::uint16_t found = 7;
      const ScanQuery query{problem.queries[0].data(), offset,
                            static_cast<std::int16_t>(largest + more), products, &found};
      EXPECT_EQ(scan(problem.codes.data(), 1, 4, &query, 1), more == 1 ? 0U : 1U);
      EXPECT_EQ(found == 0, more == 1);
    }
  });
}

TEST(Distances, AreTheSameNumbersOnEveryTarget) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  for (const std::size_t dimension : {1, 15, 16, 36, 64, 128, 131}) {
    std::vector<std::vector<float>> rows(4, std::vector<float>(dimension));
    for (auto& row : rows)
      for (float& v : row) v = normal(random);
    const float* pointers[] = {rows[1].data(), rows[2].data(), rows[0].data()};
    float expected[3];
    scalar::distances(rows[0].data(), pointers, 3, dimension, expected);
    double squares = 0;
    for (std::size_t d = 0; d < dimension; ++d)
      squares += std::pow(double(rows[0][d]) - double(rows[1][d]), 2);
    EXPECT_NEAR(expected[0], std::sqrt(squares), 1e-5);
    EXPECT_EQ(expected[2], 0.0F);
    for_each_target([&] {
      float found[3];
      distances(rows[0].data(), pointers, 3, dimension, found);
      for (int i = 0; i < 3; ++i) EXPECT_EQ(found[i], expected[i]) << dimension;
    });
  }
}

TEST(Encode, GivesTheSameNumbersOnEveryTarget) {
  std::mt19937 random(6);
  std::normal_distribution<float> normal;
  for (const std::size_t dimension : {1, 15, 16, 36, 64, 131}) {
    std::vector<float> row(dimension);
    for (float& v : row) v = normal(random);
    row[0] = 5;  // beyond what a code can hold
    std::vector<std::int8_t> codes(dimension), expected_codes(dimension);
    const Rounding expected = scalar::encode(row.data(), dimension, 50, expected_codes.data());
    EXPECT_EQ(expected_codes[0], 127);
    EXPECT_NEAR(expected_codes.back() / 50.0, std::min(row.back(), 2.54F), 0.0101);
    for_each_target([&] {
      const Rounding found = encode(row.data(), dimension, 50, codes.data());
      EXPECT_EQ(codes, expected_codes);
      EXPECT_EQ(found.squares, expected.squares) << dimension;
      EXPECT_EQ(found.lost, expected.lost) << dimension;
      EXPECT_EQ(found.sum, expected.sum);
    });
  }
}

}  // namespace
}  // namespace posevote
