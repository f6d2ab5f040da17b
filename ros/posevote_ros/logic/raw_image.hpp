// The pixels of a ROS image message, checked before they are believed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

namespace posevote::logic {

/// sensor_msgs/Image without ROS; does not own its data.
struct RawImage {
  std::uint32_t width = 0, height = 0;
  std::uint32_t step = 0;  ///< bytes per row
  std::string encoding;    ///< as in sensor_msgs/image_encodings.h
  bool is_bigendian = false;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;  ///< bytes in `data`
};

/// What cameras and their drivers send; more pixels than this are an accident or an attack.
constexpr double max_megapixels = 100;

/// A copy as grey (mono8, mono16, 8UC1, 16UC1) or BGR(A) (bgr8, rgb8, bgra8, rgba8, the same with
/// 16 bits, 8UC3, 8UC4, Bayer patterns of 8 and 16 bits, YUV 4:2:2) of 8 or 16 bits: what
/// `Extractor::extract` takes. Throws Error{unreadable_image}: no pixels, more than
/// `max_megapixels`, fewer bytes than height * step, rows that overlap, an encoding without
/// a picture's colours.
[[nodiscard]] cv::Mat to_picture(const RawImage& image);

/// The encoding that a picture of 8 bits has: "mono8", "bgr8" or "bgra8". Throws
/// Error{invalid_argument} for other types.
[[nodiscard]] std::string encoding_of(const cv::Mat& picture);

}  // namespace posevote::logic
