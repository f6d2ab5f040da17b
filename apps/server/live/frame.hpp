// One frame of the camera, shared by everybody who looks at it.
#pragma once

#include <cstdint>
#include <mutex>
#include <opencv2/core.hpp>
#include <string>

#include "http/message.hpp"
#include "live/live_options.hpp"

namespace posevote::server {

/// JPEG of an 8-bit picture. Throws Error{io} when it cannot be made.
[[nodiscard]] Bytes encode_jpeg(const cv::Mat& image, int quality);

/// `image` or a copy reduced to `width` px.
[[nodiscard]] cv::Mat reduced_to(const cv::Mat& image, int width);

/// Immutable but for the picture for streams, which is made when the first client needs it.
class LiveFrame {
 public:
  LiveFrame(cv::Mat image, std::int64_t number, double time_s, std::string source,
            const LiveOptions& options)
      : image_(std::move(image)),
        number_(number),
        time_s_(time_s),
        source_(std::move(source)),
        options_(options) {}

  [[nodiscard]] const cv::Mat& image() const { return image_; }  ///< BGR, 8 bits
  [[nodiscard]] std::int64_t number() const { return number_; }
  [[nodiscard]] double time_s() const { return time_s_; }  ///< of arrival, since the server began
  [[nodiscard]] const std::string& source() const { return source_; }
  /// Reduced and encoded once, whoever asks.
  [[nodiscard]] const Bytes& stream_jpeg() const;

 private:
  cv::Mat image_;
  std::int64_t number_;
  double time_s_;
  std::string source_;
  LiveOptions options_;
  mutable std::once_flag once_;
  mutable Bytes jpeg_;
};

}  // namespace posevote::server
