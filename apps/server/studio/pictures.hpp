// Pictures of requests to the library and back.
#pragma once

#include <optional>
#include <string>

#include "http/message.hpp"
#include "live/frame.hpp"
#include "studio/job_slots.hpp"
#include "studio/settings.hpp"

namespace posevote::server {

/// A picture as it was sent and decoded: upright, 1, 3 or 4 channels of 8 or 16 bits.
struct SentPicture {
  Bytes encoded;
  cv::Mat image;
  std::string source;  ///< "upload", or the camera's name
};

/// Throws Error{unreadable_image}: no picture, damaged, too many pixels. Nothing is decoded before
/// its size is known to be within the limits.
[[nodiscard]] cv::Mat decode_within(const Bytes& encoded, const Limits& limits);
[[nodiscard]] SentPicture decode_sent(Bytes encoded, const Limits& limits);

/// The body's part "picture", else the raw body.
[[nodiscard]] Bytes take_picture(Body& body);

/// A frame as if it had been sent: what is stored is what was looked at.
[[nodiscard]] SentPicture from_frame(const LiveFrame& frame);

[[nodiscard]] Bytes encode_png(const cv::Mat& image);

/// The picture as it is, or as JPEG reduced to the query's `width`, which is a job.
[[nodiscard]] Response picture_response(const Request& request, const Bytes& encoded,
                                        JobSlots& jobs, const Limits& limits);

/// The query's roi=x,y,width,height; throws Problem 400.
[[nodiscard]] std::optional<cv::Rect> parse_rectangle(const Request& request, const char* name);

/// The query's number within [min, max]; throws Problem 400.
[[nodiscard]] std::optional<double> parse_number(const Request& request, const char* name,
                                                 double min, double max);

/// "true" or "false"; not given: false. Throws Problem 400.
[[nodiscard]] bool parse_flag(const Request& request, const char* name);

}  // namespace posevote::server
