#include "posevote/image/frame_source.hpp"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "posevote/core/error.hpp"
#ifdef POSEVOTE_WITH_VIDEO
#include <chrono>
#include <filesystem>
#include <opencv2/videoio.hpp>
#endif

namespace posevote {
namespace {

class NewestOnly : public FrameSource {
 public:
  explicit NewestOnly(std::unique_ptr<FrameSource> source)
      : source_(std::move(source)), reader_([this] { read(); }) {}

  ~NewestOnly() override {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    reader_.join();
  }

  std::optional<Frame> next() override {
    std::unique_lock lock(mutex_);
    arrived_.wait(lock, [this] { return newest_ || ended_; });
    if (!newest_) {
      if (failure_) std::rethrow_exception(failure_);
      return std::nullopt;
    }
    std::optional<Frame> frame = std::move(newest_);
    newest_.reset();
    frame->dropped = frame->number - last_number_ - 1;
    last_number_ = frame->number;
    return frame;
  }

 private:
  void read() {
    try {
      while (auto frame = source_->next()) {
        const std::lock_guard lock(mutex_);
        if (stop_) return;
        newest_ = std::move(frame);
        arrived_.notify_one();
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    ended_ = true;
    arrived_.notify_one();
  }

  std::unique_ptr<FrameSource> source_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::optional<Frame> newest_;
  std::exception_ptr failure_;
  std::int64_t last_number_ = -1;
  bool ended_ = false;
  bool stop_ = false;
  std::thread reader_;  // the last member: it uses the others
};

#ifdef POSEVOTE_WITH_VIDEO

using Clock = std::chrono::steady_clock;

class VideoSource : public FrameSource {
 public:
  explicit VideoSource(cv::VideoCapture capture)
      : capture_(std::move(capture)),
        length_(static_cast<std::int64_t>(capture_.get(cv::CAP_PROP_FRAME_COUNT))) {}

  std::optional<Frame> next() override {
    Frame frame;
    if (!capture_.read(frame.image) || frame.image.empty()) return std::nullopt;
    frame.image = frame.image.clone();
    frame.number = count_++;
    frame.time_s = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000;  // of the frame just read
    return frame;
  }

  std::int64_t length() const override { return std::max<std::int64_t>(length_, 0); }

 private:
  cv::VideoCapture capture_;
  std::int64_t length_;
  std::int64_t count_ = 0;
};

class CameraSource : public FrameSource {
 public:
  CameraSource(cv::VideoCapture capture, int number)
      : capture_(std::move(capture)), number_(number) {}

  std::optional<Frame> next() override {
    Frame frame;
    if (!capture_.read(frame.image) || frame.image.empty())
      throw Error(ErrorCode::io, "camera " + std::to_string(number_) +
                                     " gives no more frames; is it still connected?");
    const Clock::time_point now = Clock::now();
    if (count_ == 0) start_ = now;
    frame.image = frame.image.clone();
    frame.number = count_++;
    frame.time_s = std::chrono::duration<double>(now - start_).count();
    return frame;
  }

 private:
  cv::VideoCapture capture_;
  int number_;
  Clock::time_point start_;
  std::int64_t count_ = 0;
};

[[noreturn]] void fail_video(const std::string& path, const std::string& reason) {
  throw Error(ErrorCode::unreadable_image, "cannot read video '" + path + "': " + reason);
}

#endif

}  // namespace

std::unique_ptr<FrameSource> newest_only(std::unique_ptr<FrameSource> source) {
  return std::make_unique<NewestOnly>(std::move(source));
}

#ifdef POSEVOTE_WITH_VIDEO

std::unique_ptr<FrameSource> open_video(const std::string& path, double max_megapixels) {
  std::error_code error;
  const auto type = std::filesystem::status(path, error).type();
  if (type == std::filesystem::file_type::not_found) fail_video(path, "there is no such file");
  if (type != std::filesystem::file_type::regular) fail_video(path, "it is not a regular file");
  cv::VideoCapture capture(path, cv::CAP_FFMPEG);  // other backends would take patterns or devices
  if (!capture.isOpened()) fail_video(path, "it is no video, or of a kind that cannot be decoded");
  const double pixels =
      capture.get(cv::CAP_PROP_FRAME_WIDTH) * capture.get(cv::CAP_PROP_FRAME_HEIGHT);
  if (pixels > max_megapixels * 1e6) fail_video(path, "its frames are too large");
  return std::make_unique<VideoSource>(std::move(capture));
}

std::unique_ptr<FrameSource> open_camera(int number) {
  cv::VideoCapture capture(number);
  if (!capture.isOpened())
    throw Error(ErrorCode::not_found, "cannot open camera " + std::to_string(number) +
                                          ": it is not there, in use, or not permitted");
  capture.set(cv::CAP_PROP_BUFFERSIZE, 1);
  return newest_only(std::make_unique<CameraSource>(std::move(capture), number));
}

#else

std::unique_ptr<FrameSource> open_video(const std::string& path, double) {
  throw Error(ErrorCode::unsupported,
              "cannot read video '" + path + "': this build has no video support");
}

std::unique_ptr<FrameSource> open_camera(int number) {
  throw Error(ErrorCode::unsupported,
              "cannot open camera " + std::to_string(number) + ": this build has no video support");
}

#endif

}  // namespace posevote
