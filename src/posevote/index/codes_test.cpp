#include "posevote/index/codes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "posevote/index/dots.hpp"

namespace posevote {
namespace {

std::vector<float> unit_vector(int dimension, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::vector<float> row(static_cast<std::size_t>(dimension));
  for (float& v : row) v = normal(random);
  const float length = std::sqrt(product(row.data(), row.data(), dimension));
  for (float& v : row) v /= length;
  return row;
}

/// The product that the kernel computes, over both scales.
float coded_product(const Coder& coder, const std::vector<float>& query,
                    const std::vector<float>& taught, const float* center, float scale) {
  std::vector<std::uint8_t> block(coder.block_bytes(), 7);
  std::vector<std::int8_t> code(coder.quads() * 4, 7);
  coder.encode_taught(taught.data(), center, scale, block.data(), 5);
  const QueryCode coded = coder.encode_query(query.data(), code.data());
  std::int16_t products[kBlockLanes];
  dots(block.data(), 1, coder.quads(), {{code.data()}, 1}, products, kBlockLanes);
  return static_cast<float>(products[5]) / (coded.scale * scale);
}

TEST(Coder, ProductsOfCodesAreAsFarOffAsItSays) {
  for (const int dimension : {1, 2, 3, 36, 64, 128, 131, 512}) {
    const Coder coder(dimension);
    for (unsigned seed = 0; seed < 50; ++seed) {
      const auto query = unit_vector(dimension, seed);
      const auto taught = seed % 5 == 0 ? query : unit_vector(dimension, 100 + seed);
      std::vector<std::uint8_t> block(coder.block_bytes());
      std::vector<std::int8_t> code(coder.quads() * 4);
      const float t = coder.encode_taught(taught.data(), nullptr, kUnitScale, block.data(), 0);
      const float q = coder.encode_query(query.data(), code.data()).residual;
      EXPECT_NEAR(coded_product(coder, query, taught, nullptr, kUnitScale),
                  product(query.data(), taught.data(), dimension),
                  coder.error(q, t, 1, true) + 1e-5F)
          << dimension;
      EXPECT_LE(t, 0.5F / kUnitScale * std::sqrt(static_cast<float>(dimension)) + 1e-5F);
    }
  }
}

TEST(Coder, IsFinerForWhatIsLeftWithoutACentre) {
  const Coder coder(64);
  const auto center = unit_vector(64, 1);
  auto taught = unit_vector(64, 2);
  for (std::size_t d = 0; d < 64; ++d) taught[d] = center[d] + 0.2F * taught[d];
  std::vector<std::uint8_t> block(coder.block_bytes());
  const float coarse = coder.encode_taught(taught.data(), nullptr, kUnitScale, block.data(), 0);
  const float fine = coder.encode_taught(taught.data(), center.data(), 600, block.data(), 0);
  EXPECT_LT(fine, coarse / 3);
}

TEST(Coder, StaysWithinSixteenBitsWhenCodesAreTooLong) {
  const Coder coder(64);
  const auto row = unit_vector(64, 3);
  const float found = coded_product(coder, row, row, nullptr, 1000);  // 6 times too long
  EXPECT_GT(found, 0.05F);
  EXPECT_LT(found, 1.0F);
  std::vector<std::uint8_t> block(coder.block_bytes());
  EXPECT_GT(coder.encode_taught(row.data(), nullptr, 1000, block.data(), 0), 0.5F);
}

TEST(Coder, KeepsPairsOfQueriesWithinTheKernelsLimit) {
  const Coder coder(64);
  std::vector<float> row(64, 0.0F);
  row[2] = row[3] = std::sqrt(0.5F);
  std::vector<std::int8_t> code(64);
  coder.encode_query(row.data(), code.data());
  EXPECT_LE(code[2] + code[3], 128);
  EXPECT_GT(code[2] + code[3], 120);
}

TEST(Coder, TakesWhatIsNotANumberForZero) {
  const Coder coder(4);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> broken{nan, 0.5F, std::numeric_limits<float>::infinity(), 0.5F};
  std::vector<std::int8_t> code(4);
  coder.encode_query(broken.data(), code.data());
  EXPECT_EQ(code[0], 0);
  EXPECT_EQ(code[2], 0);
  std::vector<std::uint8_t> block(coder.block_bytes(), 7);
  coder.encode_taught(broken.data(), nullptr, kUnitScale, block.data(), 1);
  for (std::size_t i = 4; i < 8; ++i) EXPECT_EQ(block[i], 128);
}

TEST(Coder, TellsWhatAQueryLost) {
  const Coder coder(37);
  const auto row = unit_vector(37, 3);
  std::vector<std::int8_t> code(coder.quads() * 4);
  const QueryCode coded = coder.encode_query(row.data(), code.data());
  std::vector<float> stands_for(37);
  int sum = 0;
  for (std::size_t d = 0; d < 37; ++d) {
    stands_for[d] = static_cast<float>(code[d]) / coded.scale;
    sum += code[d];
  }
  EXPECT_EQ(coded.offset, 128 * sum);
  EXPECT_NEAR(coded.lost, 1 - product(row.data(), stands_for.data(), 37), 1e-6);
}

TEST(Coder, DecodesWhatItEncoded) {
  const Coder coder(6);
  const std::vector<float> row{0.1F, -0.2F, 0.3F, -0.4F, 0.5F, -0.6F};
  std::vector<std::uint8_t> block(coder.block_bytes());
  coder.encode_taught(row.data(), nullptr, kUnitScale, block.data(), 15);
  std::vector<float> decoded(6);
  coder.decode_taught(block.data(), 15, kUnitScale, decoded.data());
  for (std::size_t d = 0; d < 6; ++d) EXPECT_NEAR(decoded[d], row[d], 0.5F / kUnitScale + 1e-6F);
}

TEST(Coder, EncodesAllRowsBlockByBlock) {
  const Coder coder(6);
  std::vector<std::vector<float>> rows;
  std::vector<const float*> pointers;
  pointers.reserve(kBlockLanes + 1);
  for (unsigned seed = 0; seed < kBlockLanes + 1; ++seed) rows.push_back(unit_vector(6, seed));
  for (const auto& row : rows) pointers.push_back(row.data());
  const auto codes = coder.encode_all(pointers);
  ASSERT_EQ(codes.size(), 2 * coder.block_bytes());
  std::vector<float> decoded(6);
  for (std::size_t i = 0; i < 2 * kBlockLanes; ++i) {
    coder.decode_taught(&codes[i / kBlockLanes * coder.block_bytes()], i % kBlockLanes, kUnitScale,
                        decoded.data());
    for (std::size_t d = 0; d < 6; ++d)
      EXPECT_NEAR(decoded[d], i < rows.size() ? rows[i][d] : 0, 0.5F / kUnitScale + 1e-6F);
  }
  EXPECT_TRUE(coder.encode_all({}).empty());
}

TEST(ReadRow, GivesFloatsOfHalfFloats) {
  cv::Mat halves;
  cv::Mat(cv::Matx<float, 2, 3>(1, 2, 3, 0.5F, 0.25F, -1)).convertTo(halves, CV_16F);
  std::vector<float> buffer;
  const float* row = read_row(halves, 1, buffer);
  EXPECT_EQ(row[0], 0.5F);
  EXPECT_EQ(row[2], -1.0F);
}

}  // namespace
}  // namespace posevote
