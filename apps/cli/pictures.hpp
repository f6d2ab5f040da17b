// Pictures from files to the library and back, without the codecs' chatter.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace posevote::cli {

/// Sends what codecs write to standard error to nowhere while it lives: their complaints would
/// stand beside our one sentence. For one thread at a time.
class QuietCodecs {
 public:
  QuietCodecs();
  ~QuietCodecs();
  QuietCodecs(const QuietCodecs&) = delete;
  QuietCodecs& operator=(const QuietCodecs&) = delete;

 private:
  int standard_error_;
};

struct LoadedPicture {
  cv::Mat image;
  std::vector<std::uint8_t> encoded;  ///< the file's bytes
};

/// Throws Error{unreadable_image}.
[[nodiscard]] LoadedPicture load_picture(const std::string& path);

/// Makes the folder and those above it. Throws Error{io}.
void make_folder(const std::string& folder);

/// Writes a picture (PNG or JPEG by the ending) completely or throws Error{io}.
void save_picture(const std::string& path, const cv::Mat& image);
void save_bytes(const std::string& path, const std::vector<std::uint8_t>& data);

}  // namespace posevote::cli
