#include "logic/raw_image.hpp"

#include <map>
#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"

namespace posevote::logic {
namespace {

struct Encoding {
  int type;             ///< of the pixels as they come
  int conversion = -1;  ///< cv::ColorConversionCodes; -1: none
};

/// OpenCV names a Bayer pattern by its second row, ROS by its first.
const std::map<std::string, Encoding>& encodings() {
  static const std::map<std::string, Encoding> table = {
      {"mono8", {CV_8UC1}},
      {"8UC1", {CV_8UC1}},
      {"mono16", {CV_16UC1}},
      {"16UC1", {CV_16UC1}},
      {"bgr8", {CV_8UC3}},
      {"8UC3", {CV_8UC3}},
      {"bgr16", {CV_16UC3}},
      {"16UC3", {CV_16UC3}},
      {"bgra8", {CV_8UC4}},
      {"8UC4", {CV_8UC4}},
      {"bgra16", {CV_16UC4}},
      {"16UC4", {CV_16UC4}},
      {"rgb8", {CV_8UC3, cv::COLOR_RGB2BGR}},
      {"rgb16", {CV_16UC3, cv::COLOR_RGB2BGR}},
      {"rgba8", {CV_8UC4, cv::COLOR_RGBA2BGRA}},
      {"rgba16", {CV_16UC4, cv::COLOR_RGBA2BGRA}},
      {"bayer_rggb8", {CV_8UC1, cv::COLOR_BayerBG2BGR}},
      {"bayer_bggr8", {CV_8UC1, cv::COLOR_BayerRG2BGR}},
      {"bayer_gbrg8", {CV_8UC1, cv::COLOR_BayerGR2BGR}},
      {"bayer_grbg8", {CV_8UC1, cv::COLOR_BayerGB2BGR}},
      {"bayer_rggb16", {CV_16UC1, cv::COLOR_BayerBG2BGR}},
      {"bayer_bggr16", {CV_16UC1, cv::COLOR_BayerRG2BGR}},
      {"bayer_gbrg16", {CV_16UC1, cv::COLOR_BayerGR2BGR}},
      {"bayer_grbg16", {CV_16UC1, cv::COLOR_BayerGB2BGR}},
      {"yuv422", {CV_8UC2, cv::COLOR_YUV2BGR_UYVY}},
      {"uyvy", {CV_8UC2, cv::COLOR_YUV2BGR_UYVY}},
      {"yuv422_yuy2", {CV_8UC2, cv::COLOR_YUV2BGR_YUY2}},
      {"yuyv", {CV_8UC2, cv::COLOR_YUV2BGR_YUY2}},
  };
  return table;
}

[[noreturn]] void refuse(const RawImage& image, const std::string& why) {
  throw Error(ErrorCode::unreadable_image, "image message of " + std::to_string(image.width) +
                                               " x " + std::to_string(image.height) +
                                               " px, encoding '" + image.encoding +
                                               "', cannot be used: " + why);
}

const Encoding& checked_encoding(const RawImage& image) {
  if (image.width == 0 || image.height == 0) refuse(image, "it has no pixels");
  if (static_cast<double>(image.width) * image.height > max_megapixels * 1e6)
    refuse(image,
           "it has more than " + std::to_string(static_cast<int>(max_megapixels)) + " megapixels");
  const auto found = encodings().find(image.encoding);
  if (found == encodings().end()) refuse(image, "this encoding is none of grey or colour pictures");
  const std::uint64_t row = static_cast<std::uint64_t>(image.width) *
                            static_cast<unsigned>(CV_ELEM_SIZE(found->second.type));
  if (image.step < row)
    refuse(image, "a row needs " + std::to_string(row) + " bytes, step says " +
                      std::to_string(image.step));
  const std::uint64_t needed = static_cast<std::uint64_t>(image.step) * (image.height - 1) + row;
  if (!image.data || image.size < needed)
    refuse(image,
           "it needs " + std::to_string(needed) + " bytes and has " + std::to_string(image.size));
  if (CV_MAT_CN(found->second.type) == 2 && image.width % 2 != 0)
    refuse(image, "rows of YUV 4:2:2 have an even number of pixels");
  return found->second;
}

bool is_little_endian_machine() {
  const std::uint16_t one = 1;
  return *reinterpret_cast<const std::uint8_t*>(&one) == 1;
}

void swap_bytes(cv::Mat& picture) {
  for (int y = 0; y < picture.rows; ++y) {
    auto* row = picture.ptr<std::uint16_t>(y);
    for (int i = 0; i < picture.cols * picture.channels(); ++i)
      row[i] = static_cast<std::uint16_t>((row[i] << 8) | (row[i] >> 8));
  }
}

}  // namespace

cv::Mat to_picture(const RawImage& image) {
  const Encoding& encoding = checked_encoding(image);
  const cv::Mat given(static_cast<int>(image.height), static_cast<int>(image.width), encoding.type,
                      const_cast<std::uint8_t*>(image.data), image.step);
  const bool swapped =
      CV_MAT_DEPTH(encoding.type) == CV_16U && image.is_bigendian == is_little_endian_machine();
  if (encoding.conversion < 0 || swapped) {
    cv::Mat copy = given.clone();
    if (swapped) swap_bytes(copy);
    if (encoding.conversion < 0) return copy;
    cv::Mat picture;
    cv::cvtColor(copy, picture, encoding.conversion);
    return picture;
  }
  cv::Mat picture;
  cv::cvtColor(given, picture, encoding.conversion);
  return picture;
}

std::string encoding_of(const cv::Mat& picture) {
  switch (picture.type()) {
    case CV_8UC1:
      return "mono8";
    case CV_8UC3:
      return "bgr8";
    case CV_8UC4:
      return "bgra8";
    default:
      throw Error(ErrorCode::invalid_argument, "only pictures of 8 bits are sent");
  }
}

}  // namespace posevote::logic
