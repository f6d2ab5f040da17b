#include "posevote/image/read_image.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"
#include "posevote/image/image_header.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t max_file_bytes = std::uintmax_t{1} << 30;

[[noreturn]] void fail(const std::string& name, const std::string& reason) {
  throw Error(ErrorCode::unreadable_image, "cannot read picture '" + name + "': " + reason);
}

void check_regular(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) fail(path, "there is no such file");
  if (status.type() == fs::file_type::none) fail(path, error.message());
  if (status.type() == fs::file_type::directory) fail(path, "it is a folder");
  if (status.type() != fs::file_type::regular) fail(path, "it is not a regular file");
}

cv::Mat decode(const std::vector<std::uint8_t>& data, const std::string& name) {
  cv::Mat image;
  try {
    image = cv::imdecode(data, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& error) {
    if (error.code == cv::Error::StsNoMem) fail(name, "there is not enough memory to decode it");
  }
  if (image.empty()) fail(name, "it is damaged or of a kind that cannot be decoded");
  return image;
}

/// Turns a picture as Exif orientation 1..8 demands.
cv::Mat turn_upright(const cv::Mat& image, int orientation) {
  cv::Mat turned = image;
  if (orientation >= 5) cv::transpose(image, turned);  // 5: transposed, 6: +90, 7: both, 8: -90 deg
  constexpr int no_flip = 2, around_x = 0, around_y = 1, both = -1;
  constexpr int flips[] = {no_flip, around_y, both, around_x, no_flip, around_y, both, around_x};
  const int flip = flips[orientation - 1];
  if (flip == no_flip) return turned;
  cv::Mat flipped;
  cv::flip(turned, flipped, flip);
  return flipped;
}

std::string megapixels(double pixels) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", pixels / 1e6);
  return text;
}

}  // namespace

void ReadOptions::describe(OptionList& list) {
  list.add("max_megapixels", max_megapixels, {0.001, 1000}, "MP",
           "Larger pictures are refused before they are decoded.");
  list.add("apply_exif", apply_exif, "Turn JPEG pictures as their Exif orientation says.");
}

std::vector<std::uint8_t> read_bytes(const std::string& path) {
  check_regular(path);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  if (!file) fail(path, std::strerror(errno));
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail(path, error.message());
  if (size == 0) fail(path, "the file is empty");
  if (size > max_file_bytes) fail(path, "the file is larger than 1 GiB");
  std::vector<std::uint8_t> data(size);
  data.resize(std::fread(data.data(), 1, data.size(), file.get()));
  if (data.size() != size) fail(path, "the file could not be read to its end");
  return data;
}

cv::Mat decode_image(const std::vector<std::uint8_t>& data, const std::string& name,
                     const ReadOptions& options) {
  const auto header = parse_image_header(data.data(), data.size());
  if (!header) fail(name, "it is not a JPEG, PNG, TIFF, WebP, BMP or PNM picture");
  const double pixels = static_cast<double>(header->size.width) * header->size.height;
  if (pixels > options.max_megapixels * 1e6)
    fail(name, "it has " + megapixels(pixels) + " megapixels, the limit is " +
                   megapixels(options.max_megapixels * 1e6));
  if (!header->complete) fail(name, "it is truncated; copy the file again");
  const cv::Mat image = decode(data, name);
  if (image.depth() != CV_8U && image.depth() != CV_16U)
    fail(name, "its pixels are neither 8 nor 16 bits wide; convert it");
  if (image.channels() != 1 && image.channels() != 3 && image.channels() != 4)
    fail(name, "it has " + std::to_string(image.channels()) + " channels, not 1, 3 or 4");
  return options.apply_exif ? turn_upright(image, header->orientation) : image;
}

cv::Mat read_image(const std::string& path, const ReadOptions& options) {
  return decode_image(read_bytes(path), path, options);
}

}  // namespace posevote
