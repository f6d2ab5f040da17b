#include "logic/raw_image.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "posevote/core/error.hpp"

namespace posevote::logic {
namespace {

struct Message {
  std::vector<std::uint8_t> bytes;
  RawImage image;
};

Message message(std::uint32_t width, std::uint32_t height, const std::string& encoding,
                std::vector<std::uint8_t> bytes, std::uint32_t step) {
  Message made{std::move(bytes), {}};
  made.image = {width, height, step, encoding, false, nullptr, made.bytes.size()};
  made.image.data = made.bytes.data();  // a moved vector keeps its place
  return made;
}

void expect_refused(const RawImage& image, const std::string& reason) {
  try {
    (void)to_picture(image);
    FAIL() << "was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::unreadable_image);
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}

TEST(RawImage, KeepsBgrAndTurnsRgbRound) {
  const auto bgr = message(1, 1, "bgr8", {1, 2, 3}, 3);
  EXPECT_EQ(to_picture(bgr.image).at<cv::Vec3b>(0, 0), cv::Vec3b(1, 2, 3));
  const auto rgb = message(1, 1, "rgb8", {1, 2, 3}, 3);
  EXPECT_EQ(to_picture(rgb.image).at<cv::Vec3b>(0, 0), cv::Vec3b(3, 2, 1));
  const auto rgba = message(1, 1, "rgba8", {1, 2, 3, 4}, 4);
  EXPECT_EQ(to_picture(rgba.image).at<cv::Vec4b>(0, 0), cv::Vec4b(3, 2, 1, 4));
}

TEST(RawImage, SkipsThePaddingOfRows) {
  const auto padded = message(2, 2, "mono8", {1, 2, 99, 99, 3, 4, 99, 99}, 4);
  const cv::Mat picture = to_picture(padded.image);
  EXPECT_EQ(picture.at<std::uint8_t>(1, 0), 3);
  EXPECT_EQ(picture.at<std::uint8_t>(1, 1), 4);
}

TEST(RawImage, NeedsNoPaddingAfterTheLastRow) {
  const auto padded = message(2, 2, "mono8", {1, 2, 99, 99, 3, 4}, 4);
  EXPECT_EQ(to_picture(padded.image).at<std::uint8_t>(1, 1), 4);
}

TEST(RawImage, ReadsSixteenBitsOfEitherOrder) {
  auto grey = message(1, 1, "mono16", {0x34, 0x12}, 2);
  EXPECT_EQ(to_picture(grey.image).at<std::uint16_t>(0, 0), 0x1234);
  grey.image.is_bigendian = true;
  EXPECT_EQ(to_picture(grey.image).at<std::uint16_t>(0, 0), 0x3412);
}

TEST(RawImage, DecodesYuv) {
  const auto grey = message(2, 1, "yuv422", {128, 235, 128, 16}, 4);
  const cv::Mat uyvy = to_picture(grey.image);
  EXPECT_GT(uyvy.at<cv::Vec3b>(0, 0)[1], 250);
  EXPECT_LT(uyvy.at<cv::Vec3b>(0, 1)[1], 5);
  const auto other = message(2, 1, "yuv422_yuy2", {235, 128, 16, 128}, 4);
  EXPECT_EQ(cv::norm(uyvy, to_picture(other.image), cv::NORM_INF), 0);
}

/// A patch of pure red seen through each pattern stays red.
TEST(RawImage, KnowsTheBayerPatterns) {
  const std::vector<std::pair<std::string, cv::Point>> red_at = {{"bayer_rggb8", {0, 0}},
                                                                 {"bayer_grbg8", {1, 0}},
                                                                 {"bayer_gbrg8", {0, 1}},
                                                                 {"bayer_bggr8", {1, 1}}};
  for (const auto& [encoding, red] : red_at) {
    std::vector<std::uint8_t> bytes(64, 0);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x)
        if (x % 2 == red.x && y % 2 == red.y) bytes[8 * y + x] = 200;
    const auto mosaic = message(8, 8, encoding, bytes, 8);
    const cv::Vec3b colour = to_picture(mosaic.image).at<cv::Vec3b>(4, 4);
    EXPECT_EQ(colour, cv::Vec3b(0, 0, 200)) << encoding;
  }
}

TEST(RawImage, OwnsItsPixels) {
  auto grey = message(1, 1, "mono8", {7}, 1);
  const cv::Mat picture = to_picture(grey.image);
  grey.bytes[0] = 9;
  EXPECT_EQ(picture.at<std::uint8_t>(0, 0), 7);
}

TEST(RawImage, RefusesWhatDoesNotAddUp) {
  expect_refused(message(0, 0, "mono8", {}, 0).image, "no pixels");
  expect_refused(message(4, 2, "mono8", {1, 2, 3, 4, 5, 6, 7}, 4).image, "needs 8 bytes");
  expect_refused(message(4, 2, "mono8", std::vector<std::uint8_t>(8), 3).image, "step says 3");
  expect_refused(message(1, 1, "32FC1", {1, 2, 3, 4}, 4).image, "encoding");
  expect_refused(message(3, 1, "yuv422", std::vector<std::uint8_t>(6), 6).image, "even number");
  RawImage nothing{1, 1, 1, "mono8", false, nullptr, 1};
  expect_refused(nothing, "needs 1 bytes");
}

TEST(RawImage, RefusesHugeImagesBeforeReadingThem) {
  const std::vector<std::uint8_t> few(16);
  expect_refused({4000000000u, 4000000000u, 4000000000u, "mono8", false, few.data(), few.size()},
                 "megapixels");
  expect_refused({65536, 1000, 4u, "bgra16", false, few.data(), few.size()}, "a row needs 524288");
}

TEST(RawImage, NamesTheEncodingOfPictures) {
  EXPECT_EQ(encoding_of(cv::Mat(1, 1, CV_8UC1)), "mono8");
  EXPECT_EQ(encoding_of(cv::Mat(1, 1, CV_8UC3)), "bgr8");
  EXPECT_EQ(encoding_of(cv::Mat(1, 1, CV_8UC4)), "bgra8");
  EXPECT_THROW((void)encoding_of(cv::Mat(1, 1, CV_32FC1)), Error);
}

}  // namespace
}  // namespace posevote::logic
