#include "posevote/store/blob.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "posevote/store/made_views.hpp"

namespace posevote {
namespace {

using testing::StartsWith;

BlobView all_of(const Blob& blob) {
  return {blob.data(), blob.size()};
}

TEST(Blob, FeaturesSurviveTheRoundTrip) {
  for (const int count : {0, 1, 17}) {
    const Features features = made_features(3, count);
    const Features read = decode_features(all_of(encode_keypoints(features)),
                                          all_of(encode_descriptors(features)), count ? 64 : 0);
    ASSERT_EQ(read.size(), features.size());
    EXPECT_EQ(encode_keypoints(read), encode_keypoints(features));
    EXPECT_EQ(encode_descriptors(read), encode_descriptors(features));
  }
}

TEST(Blob, TheFormatIsFixed) {
  Features features;
  features.keypoints.push_back({1, 2, 3, -1, 0.5F, -1});
  const Blob expected{0,    0, 0x80, 0x3f, 0,    0, 0, 0x40, 0,    0,   0x40,
                      0x40, 0, 0,    0x80, 0xbf, 0, 0, 0,    0x3f, 0xff};
  EXPECT_EQ(encode_keypoints(features), expected);
}

TEST(Blob, SizesThatDoNotFitAreRefused) {
  const Features features = made_features(3, 4);
  const Blob points = encode_keypoints(features), rows = encode_descriptors(features);
  const auto decode = [&](std::size_t point_bytes, std::size_t row_bytes, int dimension) {
    return error_of([&] {
      static_cast<void>(
          decode_features({points.data(), point_bytes}, {rows.data(), row_bytes}, dimension));
    });
  };
  EXPECT_EQ(decode(points.size(), rows.size(), 64), "");
  const std::string damaged = "database_unusable";
  EXPECT_THAT(decode(points.size() - 1, rows.size(), 64), StartsWith(damaged));
  EXPECT_THAT(decode(points.size() - 21, rows.size(), 64), StartsWith(damaged));
  EXPECT_THAT(decode(points.size(), rows.size() - 4, 64), StartsWith(damaged));
  EXPECT_THAT(decode(points.size(), rows.size(), 65), StartsWith(damaged));
  EXPECT_THAT(decode(points.size(), 0, 0), StartsWith(damaged));
  EXPECT_THAT(decode(points.size(), rows.size(), -64), StartsWith(damaged));
  EXPECT_THAT(decode(0, 0, 4097), StartsWith(damaged));
  EXPECT_THAT(decode(0, 4, 1), StartsWith(damaged));
}

TEST(Blob, NumbersThatAreNotFiniteAreRefused) {
  Features features = made_features(3, 2);
  features.descriptors.at<float>(1, 5) = std::numeric_limits<float>::infinity();
  EXPECT_THAT(error_of([&] {
                static_cast<void>(decode_features(all_of(encode_keypoints(features)),
                                                  all_of(encode_descriptors(features)), 64));
              }),
              StartsWith("database_unusable"));
  EXPECT_THAT(error_of([&] {
                static_cast<void>(decode_points(all_of(encode_points({{0, std::nanf("")}}))));
              }),
              StartsWith("database_unusable"));
}

TEST(Blob, PointsSurviveTheRoundTrip) {
  const std::vector<cv::Point2f> points{{1, 2}, {-3.5F, 4e6F}};
  EXPECT_EQ(decode_points(all_of(encode_points(points))), points);
  EXPECT_TRUE(decode_points({}).empty());
  const Blob blob = encode_points(points);
  EXPECT_THAT(error_of([&] {
                static_cast<void>(decode_points({blob.data(), 15}));
              }),
              StartsWith("database_unusable"));
}

TEST(PatchBlob, ComesBackAsItWas) {
  Patch patch;
  patch.pixels = cv::Mat(7, 5, CV_8UC3, cv::Scalar(1, 2, 3));
  patch.mask = cv::Mat(7, 5, CV_8U, cv::Scalar(255));
  patch.scale = 2.5;
  patch.corner = {-1.5, 8};
  const Blob bytes = encode_patch(patch);
  const Patch read = decode_patch({bytes.data(), bytes.size()});
  EXPECT_EQ(cv::norm(read.pixels, patch.pixels), 0);
  EXPECT_EQ(cv::norm(read.mask, patch.mask), 0);
  EXPECT_EQ(read.scale, patch.scale);
  EXPECT_EQ(read.corner, patch.corner);
  EXPECT_TRUE(decode_patch({}).empty());
}

TEST(PatchBlob, DamageIsSaid) {
  Patch patch;
  patch.pixels = cv::Mat(7, 5, CV_8UC3, cv::Scalar(1, 2, 3));
  patch.mask = cv::Mat(7, 5, CV_8U, cv::Scalar(255));
  Blob bytes = encode_patch(patch);
  EXPECT_THROW(static_cast<void>(decode_patch({bytes.data(), bytes.size() - 1})), Error);
  EXPECT_THROW(static_cast<void>(decode_patch({bytes.data(), 9})), Error);
  bytes[3] = 0x7f;  // an enormous width
  EXPECT_THROW(static_cast<void>(decode_patch({bytes.data(), bytes.size()})), Error);
}

}  // namespace
}  // namespace posevote
