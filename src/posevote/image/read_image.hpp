// Pictures from files and memory, for everybody: bounded, turned upright, unchanged otherwise.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/core/options.hpp"

namespace posevote {

struct ReadOptions {
  double max_megapixels = 100;  ///< larger pictures are refused before they are decoded
  bool apply_exif = true;       ///< turn JPEG pictures as their Exif orientation says
  void describe(OptionList& list);
};

/// The picture in file `path`: JPEG, PNG, TIFF, WebP, BMP or PNM; 1, 3 (BGR) or 4 (BGRA) channels
/// of 8 or 16 bits as stored. Throws Error{unreadable_image} with the path and the reason: no such
/// file, a folder, no permission, no picture, truncated, damaged, too large, pixels of another
/// type.
[[nodiscard]] cv::Mat read_image(const std::string& path, const ReadOptions& options = {});

/// The same of a picture in memory; `name` stands for it in messages.
[[nodiscard]] cv::Mat decode_image(const std::vector<std::uint8_t>& data, const std::string& name,
                                   const ReadOptions& options = {});

/// The bytes of a regular file. Throws Error{unreadable_image}: see `read_image`; also above 1 GiB.
[[nodiscard]] std::vector<std::uint8_t> read_bytes(const std::string& path);

}  // namespace posevote
