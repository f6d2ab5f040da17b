// Where live frames come from: cameras, streams, files, folders, clients.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>

#include "posevote/image/frame_source.hpp"

namespace posevote::server {

/// Frames that clients post; the newest counts. Safe for many threads.
class PostedFrames {
 public:
  void post(cv::Mat image);
  /// Empty when none is posted within `wait_s`, or it was interrupted.
  [[nodiscard]] cv::Mat take(double wait_s);
  /// Ends waiting once.
  void interrupt();

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  cv::Mat newest_;
  bool interrupted_ = false;
};

struct SourceOptions {
  double fps = 5;  ///< of folders
  double max_megapixels = 25;
  double silence_s = 5;  ///< without a frame: something is wrong, whatever the driver says
};

/// A source as people choose it, and as it is opened.
struct SourceChoice {
  std::string name;     ///< "camera:0", "client", a path, an address without password
  std::string address;  ///< the same with the password
};

/// What an argument of --camera stands for; "0" is "camera:0".
[[nodiscard]] SourceChoice parse_source(const std::string& argument);

/// Opens a source by address: "camera:N", /dev/videoN or a link to it such as /dev/v4l/by-id/...,
/// which finds a camera under its new number again; rtsp://, http:// or https:// address; a folder
/// of pictures, shown one after the other again and again; a video file, in its own time, again and
/// again; "client". Throws Error with the reason.
[[nodiscard]] std::unique_ptr<FrameSource> open_source(const std::string& address,
                                                       const SourceOptions& options,
                                                       PostedFrames& posted);

}  // namespace posevote::server
