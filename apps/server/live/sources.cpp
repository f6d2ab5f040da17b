#include "live/sources.hpp"

#include <chrono>
#include <filesystem>
#include <thread>

#include "posevote/core/error.hpp"
#include "posevote/image/inputs.hpp"
#include "posevote/image/read_image.hpp"
#include "posevote/teach/segment.hpp"

namespace posevote::server {
namespace {

using Clock = std::chrono::steady_clock;

Clock::duration seconds(double value) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(value));
}

/// The pictures of a folder, in order, again and again; looked up anew in each round.
class FolderSource : public FrameSource {
 public:
  FolderSource(std::string folder, const SourceOptions& options)
      : folder_(std::move(folder)), options_(options), due_(Clock::now()) {
    pictures_ = expand_input(folder_);
  }

  std::optional<Frame> next() override {
    std::this_thread::sleep_until(due_);
    due_ = std::max(due_ + seconds(1 / options_.fps), Clock::now());
    ReadOptions read;
    read.max_megapixels = options_.max_megapixels;
    std::string reason;
    for (std::size_t tried = 0; tried <= pictures_.size(); ++tried) {
      if (at_ == pictures_.size()) {
        pictures_ = expand_input(folder_);
        at_ = 0;
      }
      const std::string path = pictures_[at_++].path;
      try {
        Frame frame;
        frame.image = to_bgr8(read_image(path, read));
        frame.number = number_++;
        frame.time_s = static_cast<double>(frame.number) / options_.fps;
        return frame;
      } catch (const Error& error) {
        reason = error.what();
      }
    }
    if (!std::filesystem::is_directory(folder_))
      throw Error(ErrorCode::not_found, "folder '" + folder_ + "' is not there any more");
    throw Error(ErrorCode::io, "no picture of folder '" + folder_ + "' can be read: " + reason);
  }

 private:
  std::string folder_;
  SourceOptions options_;
  Clock::time_point due_;
  std::vector<Input> pictures_;
  std::size_t at_ = 0;
  std::int64_t number_ = 0;
};

/// A video file in its own time.
class PacedVideo : public FrameSource {
 public:
  PacedVideo(std::string path, double max_megapixels)
      : path_(std::move(path)), max_megapixels_(max_megapixels) {
    begin();
  }

  std::optional<Frame> next() override {
    std::optional<Frame> frame = video_->next();
    if (!frame) {
      if (shown_ == 0)
        throw Error(ErrorCode::unreadable_image,
                    "cannot read video '" + path_ + "': it holds no frames");
      begin();
      frame = video_->next();
      if (!frame) throw Error(ErrorCode::io, "video '" + path_ + "' gives no more frames");
    }
    std::this_thread::sleep_until(begin_ + seconds(frame->time_s));
    ++shown_;
    frame->number = number_++;
    return frame;
  }

 private:
  void begin() {
    video_ = open_video(path_, max_megapixels_);
    begin_ = Clock::now();
    shown_ = 0;
  }

  std::string path_;
  double max_megapixels_;
  std::unique_ptr<FrameSource> video_;
  Clock::time_point begin_;
  std::int64_t shown_ = 0, number_ = 0;
};

class ClientSource : public FrameSource {
 public:
  explicit ClientSource(PostedFrames& posted) : posted_(posted) {}

  std::optional<Frame> next() override {
    Frame frame;
    frame.image = posted_.take(5);
    if (frame.image.empty()) throw Error(ErrorCode::io, "no client sends frames at the moment");
    frame.number = number_++;
    return frame;
  }

 private:
  PostedFrames& posted_;
  std::int64_t number_ = 0;
};

/// What a link stands for at the moment, even when that is not there.
std::string link_target(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code no_link;
  const fs::path target = fs::read_symlink(path, no_link);
  return no_link ? path : (fs::path(path).parent_path() / target).lexically_normal().string();
}

}  // namespace

void PostedFrames::post(cv::Mat image) {
  const std::lock_guard lock(mutex_);
  newest_ = std::move(image);
  arrived_.notify_one();
}

cv::Mat PostedFrames::take(double wait_s) {
  std::unique_lock lock(mutex_);
  arrived_.wait_for(lock, seconds(wait_s), [this] { return !newest_.empty() || interrupted_; });
  interrupted_ = false;
  return std::exchange(newest_, cv::Mat());
}

void PostedFrames::interrupt() {
  const std::lock_guard lock(mutex_);
  interrupted_ = true;
  arrived_.notify_one();
}

SourceChoice parse_source(const std::string& argument) {
  const bool number =
      !argument.empty() && argument.find_first_not_of("0123456789") == std::string::npos;
  const std::string address = number ? "camera:" + argument : argument;
  return {without_password(address), address};
}

std::unique_ptr<FrameSource> open_source(const std::string& address, const SourceOptions& options,
                                         PostedFrames& posted) {
  if (address == "client") return std::make_unique<ClientSource>(posted);
  for (const char* scheme : {"rtsp://", "rtsps://", "http://", "https://"})
    if (address.starts_with(scheme)) return open_stream(address, options.max_megapixels);
  const std::string device = link_target(address), devices = "/dev/", cameras = "/dev/video";
  if (device.starts_with(cameras))
    return open_camera(expand_input("camera:" + device.substr(cameras.size())).front().camera,
                       options.max_megapixels);
  if (device.starts_with(devices))
    throw Error(ErrorCode::not_found, "there is no camera '" + address + "' at the moment");
  if (std::filesystem::is_directory(address))
    return std::make_unique<FolderSource>(address, options);
  const Input input = expand_input(address).front();
  if (input.kind == InputKind::camera) return open_camera(input.camera, options.max_megapixels);
  if (!std::filesystem::exists(address))
    throw Error(ErrorCode::not_found, "there is no folder or video '" + address + "'");
  return std::make_unique<PacedVideo>(address, options.max_megapixels);
}

}  // namespace posevote::server
