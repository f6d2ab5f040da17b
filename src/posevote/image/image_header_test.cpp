#include "posevote/image/image_header.hpp"

#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace posevote {
namespace {

using Data = std::vector<std::uint8_t>;

Data encode(const std::string& ending, const cv::Mat& image) {
  Data data;
  cv::imencode(ending, image, data);
  return data;
}

cv::Mat noise(cv::Size size, int type) {
  cv::Mat image(size, type);
  cv::RNG(7).fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

struct Case {
  const char* ending;
  const char* format;
  bool end_is_known;
};

class Formats : public testing::TestWithParam<Case> {};

TEST_P(Formats, SizeIsThatOfThePicture) {
  const Data data = encode(GetParam().ending, noise({37, 21}, CV_8UC3));
  const auto header = parse_image_header(data.data(), data.size());
  ASSERT_TRUE(header.has_value());
  EXPECT_EQ(header->format, GetParam().format);
  EXPECT_EQ(header->size, cv::Size(37, 21));
  EXPECT_EQ(header->orientation, 1);
  EXPECT_TRUE(header->complete);
}

TEST_P(Formats, EveryPrefixIsIncompleteOrNothing) {
  const Data data = encode(GetParam().ending, noise({9, 5}, CV_8UC3));
  for (std::size_t size = 0; size + 1 < data.size(); ++size) {
    const Data prefix(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(size));
    const auto header = parse_image_header(prefix.data(), prefix.size());
    if (!header || !GetParam().end_is_known) continue;
    EXPECT_FALSE(header->complete) << size;
  }
}

TEST_P(Formats, AnyByteMayBeWrongWithoutHarm) {
  const Data data = encode(GetParam().ending, noise({9, 5}, CV_8UC3));
  for (std::size_t i = 0; i < data.size(); ++i) {
    for (const int value : {0x00, 0x7f, 0xff}) {
      Data wrong = data;
      wrong[i] = static_cast<std::uint8_t>(value);
      const auto header = parse_image_header(wrong.data(), wrong.size());
      EXPECT_TRUE(!header || !header->size.empty());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Formats,
                         testing::Values(Case{".jpg", "jpeg", true}, Case{".png", "png", true},
                                         Case{".tiff", "tiff", false}, Case{".webp", "webp", true},
                                         Case{".bmp", "bmp", true}, Case{".ppm", "pnm", true}),
                         [](const auto& param) { return std::string(param.param.format); });

TEST(ImageHeader, NoPictureGivesNothing) {
  EXPECT_FALSE(parse_image_header(nullptr, 0));
  const std::string text = "This is no picture, it only says so.";
  EXPECT_FALSE(parse_image_header(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

TEST(ImageHeader, LosslessWebpAndTopDownBmpHaveASize) {
  Data webp;
  cv::imencode(".webp", noise({301, 17}, CV_8UC4), webp, {cv::IMWRITE_WEBP_QUALITY, 101});
  EXPECT_EQ(parse_image_header(webp.data(), webp.size())->size, cv::Size(301, 17));
  Data bmp = encode(".bmp", noise({4, 3}, CV_8UC3));
  const Data minus_three{0xfd, 0xff, 0xff, 0xff};
  std::copy(minus_three.begin(), minus_three.end(), bmp.begin() + 22);
  EXPECT_EQ(parse_image_header(bmp.data(), bmp.size())->size, cv::Size(4, 3));
}

TEST(ImageHeader, PnmCommentsAreSkipped) {
  const std::string text = "P5 # width comes\n# now\n 2\n1 255\nab";
  const auto header =
      parse_image_header(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  ASSERT_TRUE(header);
  EXPECT_EQ(header->size, cv::Size(2, 1));
  EXPECT_TRUE(header->complete);
}

}  // namespace
}  // namespace posevote
