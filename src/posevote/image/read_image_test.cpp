#include "posevote/image/read_image.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Data = std::vector<std::uint8_t>;

class ReadImage : public testing::Test {
 protected:
  ReadImage() { fs::create_directories(folder_); }
  ~ReadImage() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const Data& data) const {
    std::ofstream(path(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(data.data()),
               static_cast<std::streamsize>(data.size()));
    return path(name);
  }
  std::string write(const std::string& name, const cv::Mat& image) const {
    cv::imwrite(path(name), image);
    return path(name);
  }

  fs::path folder_ = fs::temp_directory_path() / ("read_image_test." + std::to_string(getpid()));
};

/// A picture whose corners differ: white top left, grey top right, black below.
cv::Mat corners(int width, int height) {
  cv::Mat image = cv::Mat::zeros(height, width, CV_8U);
  image(cv::Rect(0, 0, width / 2, height / 2)) = 255;
  image(cv::Rect(width / 2, 0, width - width / 2, height / 2)) = 128;
  return image;
}

Data with_exif(const cv::Mat& image, std::uint8_t orientation) {
  Data data;
  cv::imencode(".jpg", image, data, {cv::IMWRITE_JPEG_QUALITY, 100});
  const Data exif{0xff, 0xe1, 0, 34, 'E', 'x', 'i', 'f', 0, 0, 'M', 'M',         0, 42, 0, 0, 0, 8,
                  0,    1,    1, 18, 0,   3,   0,   0,   0, 1, 0,   orientation, 0, 0,  0, 0, 0, 0};
  data.insert(data.begin() + 2, exif.begin(), exif.end());
  return data;
}

std::string error_of(const std::string& path, const ReadOptions& options = {}) {
  try {
    static_cast<void>(read_image(path, options));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::unreadable_image);
    EXPECT_THAT(error.what(), HasSubstr(path));
    return error.what();
  }
  return "no error";
}

TEST_F(ReadImage, DepthAndChannelsStayAsStored) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_16UC4}) {
    cv::Mat image(6, 7, type);
    cv::randu(image, 0, 250);
    const cv::Mat read = read_image(write("x.png", image));
    ASSERT_EQ(read.type(), type);
    EXPECT_EQ(cv::norm(read, image, cv::NORM_INF), 0);
  }
}

TEST_F(ReadImage, OnePixelIsAPicture) {
  EXPECT_EQ(read_image(write("x.png", cv::Mat(1, 1, CV_8UC3, cv::Scalar(1, 2, 3)))).size(),
            cv::Size(1, 1));
}

TEST_F(ReadImage, ExifOrientationIsApplied) {
  // Brightness of top left, top right, bottom left, bottom right after each orientation.
  const std::vector<std::vector<int>> expected{{255, 128, 0, 0}, {128, 255, 0, 0}, {0, 0, 128, 255},
                                               {0, 0, 255, 128}, {255, 0, 128, 0}, {0, 255, 0, 128},
                                               {0, 128, 0, 255}, {128, 0, 255, 0}};
  for (std::uint8_t orientation = 1; orientation <= 8; ++orientation) {
    const cv::Mat image = read_image(write("x.jpg", with_exif(corners(32, 16), orientation)));
    ASSERT_EQ(image.size(), orientation < 5 ? cv::Size(32, 16) : cv::Size(16, 32));
    const std::vector<cv::Point> places{
        {1, 1}, {image.cols - 2, 1}, {1, image.rows - 2}, {image.cols - 2, image.rows - 2}};
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(image.at<std::uint8_t>(places[i]), expected[orientation - 1][i], 6)
          << "orientation " << int{orientation} << ", corner " << i;
  }
}

TEST_F(ReadImage, ExifCanBeIgnored) {
  ReadOptions options;
  options.apply_exif = false;
  EXPECT_EQ(read_image(write("x.jpg", with_exif(corners(32, 16), 6)), options).size(),
            cv::Size(32, 16));
}

TEST_F(ReadImage, NonsenseOrientationIsIgnored) {
  EXPECT_EQ(read_image(write("x.jpg", with_exif(corners(32, 16), 9))).size(), cv::Size(32, 16));
}

TEST_F(ReadImage, WhatIsNoPictureIsRefusedWithTheReason) {
  EXPECT_THAT(error_of(path("none.png")), HasSubstr("no such file"));
  EXPECT_THAT(error_of(folder_.string()), HasSubstr("folder"));
  EXPECT_THAT(error_of("/dev/zero"), HasSubstr("regular"));
  EXPECT_THAT(error_of(write("x.png", Data{})), HasSubstr("empty"));
  EXPECT_THAT(error_of(write("x.png", Data{'h', 'e', 'l', 'l', 'o'})), HasSubstr("not a JPEG"));
}

TEST_F(ReadImage, NoPermissionIsSaid) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const std::string file = write("x.png", corners(4, 4));
  chmod(file.c_str(), 0);
  EXPECT_THAT(error_of(file), HasSubstr("ermission"));
}

TEST_F(ReadImage, TruncatedFilesAreRefused) {
  for (const char* ending : {".jpg", ".png", ".webp", ".bmp", ".ppm", ".tiff"}) {
    Data data;
    cv::Mat image(64, 64, CV_8UC3);
    cv::randu(image, 0, 255);
    cv::imencode(ending, image, data);
    data.resize(data.size() / 2);
    EXPECT_NE(error_of(write(std::string("x") + ending, data)), "no error") << ending;
  }
}

TEST_F(ReadImage, DamagedPngIsRefused) {
  Data data;
  cv::imencode(".png", corners(64, 64), data);
  data[data.size() / 2] ^= 0x55;
  EXPECT_THAT(error_of(write("x.png", data)), HasSubstr("damaged"));
}

TEST_F(ReadImage, HugePicturesAreRefusedByTheirHeader) {
  Data data;
  cv::imencode(".png", corners(4, 4), data);
  const Data size{0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60};
  std::copy(size.begin(), size.end(), data.begin() + 16);
  EXPECT_THAT(error_of(write("x.png", data)), HasSubstr("3600 megapixels, the limit is 100"));
}

TEST_F(ReadImage, TheLimitIsInclusive) {
  ReadOptions options;
  options.max_megapixels = 0.01;
  EXPECT_EQ(read_image(write("x.png", corners(100, 100)), options).cols, 100);
  EXPECT_THAT(error_of(write("y.png", corners(101, 100)), options), HasSubstr("limit"));
}

TEST_F(ReadImage, FloatingPointPixelsAreRefused) {
  EXPECT_THAT(error_of(write("x.tiff", cv::Mat(4, 4, CV_32F, cv::Scalar(0.5)))),
              HasSubstr("8 nor 16"));
}

}  // namespace
}  // namespace posevote
