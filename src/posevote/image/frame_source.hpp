// Frames one after the other: of a video file, or the newest one of a camera.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace posevote {

struct Frame {
  cv::Mat image;             ///< BGR, 8 bits; the receiver's own
  std::int64_t number = 0;   ///< counted by the source from 0, dropped frames included
  std::int64_t dropped = 0;  ///< frames left out since the one before
  double time_s = 0;         ///< since the first frame: video time, or arrival for cameras
  std::chrono::steady_clock::time_point arrived;  ///< when it could first have been looked at
};

/// Used by one thread at a time.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// The next frame; waits for it; empty at the end. Throws Error{io} when the source breaks down.
  [[nodiscard]] virtual std::optional<Frame> next() = 0;
  /// Number of frames if it is known beforehand, else 0.
  [[nodiscard]] virtual std::int64_t length() const { return 0; }
};

/// Every frame of a video file. Throws Error{unreadable_image}: missing, no video, frames larger
/// than `max_megapixels`; Error{unsupported} in a build without video.
[[nodiscard]] std::unique_ptr<FrameSource> open_video(const std::string& path,
                                                      double max_megapixels = 100);

/// The newest frame of the N-th camera; frames that arrive while the receiver is busy are dropped.
/// Throws Error{not_found} when there is none or it is in use, Error{io} when its frames are larger
/// than `max_megapixels`, Error{unsupported} as above.
[[nodiscard]] std::unique_ptr<FrameSource> open_camera(int number, double max_megapixels = 100);

/// The newest frame of a network camera: rtsp://, rtsps://, http:// or https:// address. Throws
/// Error{io} when nothing answers there within some seconds, it is no video or its frames are
/// larger than `max_megapixels`, Error{unsupported} as above. The address may hold a password:
/// messages leave it out.
[[nodiscard]] std::unique_ptr<FrameSource> open_stream(const std::string& url,
                                                       double max_megapixels = 100);

/// The address without user name and password: for messages, and for people who may look at the
/// pictures but not at the camera's settings.
[[nodiscard]] std::string without_password(const std::string& url);

/// Reads `source` in a thread of its own and hands out its newest frame only. Ends (or throws) when
/// `source` does, after the newest frame was handed out.
[[nodiscard]] std::unique_ptr<FrameSource> newest_only(std::unique_ptr<FrameSource> source);

/// The frames of a video no sooner than they are due when it is played: as a camera gives them.
[[nodiscard]] std::unique_ptr<FrameSource> at_its_pace(std::unique_ptr<FrameSource> video);

}  // namespace posevote
