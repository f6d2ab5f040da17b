// What the first bytes of a picture file say, before anything is decoded or allocated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace posevote {

struct ImageHeader {
  std::string format;    ///< "jpeg", "png", "tiff", "webp", "bmp" or "pnm"
  cv::Size size;         ///< px as stored, before `orientation` is applied
  int orientation = 1;   ///< Exif orientation 1..8 of a JPEG, else 1
  bool complete = true;  ///< false: the data ends before the format says that it does
};

/// Reads the header of encoded picture `data`. Empty when it is none of the formats above or holds
/// no size. Looks only at bytes inside `data`, whatever lengths these bytes claim. Completeness is
/// judged for JPEG (end marker), PNG (end chunk), WebP, BMP and binary PNM (length).
[[nodiscard]] std::optional<ImageHeader> parse_image_header(const std::uint8_t* data,
                                                            std::size_t size);

}  // namespace posevote
