#include "posevote/image/frame_source.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "posevote/core/error.hpp"
#ifdef POSEVOTE_WITH_VIDEO
#include <filesystem>
#include <opencv2/videoio.hpp>
#endif

namespace posevote {
namespace {

class NewestOnly : public FrameSource {
 public:
  explicit NewestOnly(std::unique_ptr<FrameSource> source)
      : source_(std::move(source)), length_(source_->length()), reader_([this] { read(); }) {}

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

  [[nodiscard]] std::int64_t length() const override { return length_; }

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
  std::int64_t length_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::optional<Frame> newest_;
  std::exception_ptr failure_;
  std::int64_t last_number_ = -1;
  bool ended_ = false;
  bool stop_ = false;
  std::thread reader_;  // the last member: it uses the others
};

using Clock = std::chrono::steady_clock;

class AtItsPace : public FrameSource {
 public:
  explicit AtItsPace(std::unique_ptr<FrameSource> video) : video_(std::move(video)) {}

  std::optional<Frame> next() override {
    std::optional<Frame> frame = video_->next();
    if (!frame) return frame;
    if (!start_) start_ = Clock::now();
    frame->arrived = *start_ + std::chrono::duration_cast<Clock::duration>(
                                   std::chrono::duration<double>(frame->time_s));
    std::this_thread::sleep_until(frame->arrived);
    return frame;
  }

  [[nodiscard]] std::int64_t length() const override { return video_->length(); }

 private:
  std::unique_ptr<FrameSource> video_;
  std::optional<Clock::time_point> start_;
};

#ifdef POSEVOTE_WITH_VIDEO

class VideoSource : public FrameSource {
 public:
  explicit VideoSource(const cv::VideoCapture& capture)
      : capture_(capture),
        length_(static_cast<std::int64_t>(capture_.get(cv::CAP_PROP_FRAME_COUNT))) {}

  std::optional<Frame> next() override {
    Frame frame;
    if (!capture_.read(frame.image) || frame.image.empty()) return std::nullopt;
    frame.image = frame.image.clone();
    frame.number = count_++;
    frame.time_s = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000;  // of the frame just read
    frame.arrived = Clock::now();
    return frame;
  }

  std::int64_t length() const override { return std::max<std::int64_t>(length_, 0); }

 private:
  cv::VideoCapture capture_;
  std::int64_t length_;
  std::int64_t count_ = 0;
};

double pixels_of(const cv::VideoCapture& capture) {
  return capture.get(cv::CAP_PROP_FRAME_WIDTH) * capture.get(cv::CAP_PROP_FRAME_HEIGHT);
}

class CameraSource : public FrameSource {
 public:
  CameraSource(const cv::VideoCapture& capture, std::string name, double max_megapixels)
      : capture_(capture), name_(std::move(name)), max_megapixels_(max_megapixels) {
    check_size(pixels_of(capture_));
  }

  std::optional<Frame> next() override {
    Frame frame;
    if (!capture_.read(frame.image) || frame.image.empty())
      throw Error(ErrorCode::io, name_ + " gives no more frames; is it still connected?");
    check_size(static_cast<double>(frame.image.total()));
    frame.arrived = Clock::now();
    if (count_ == 0) start_ = frame.arrived;
    frame.image = frame.image.clone();
    frame.number = count_++;
    frame.time_s = std::chrono::duration<double>(frame.arrived - start_).count();
    return frame;
  }

 private:
  void check_size(double pixels) const {
    if (pixels > max_megapixels_ * 1e6)
      throw Error(ErrorCode::io, name_ + " gives frames that are too large");
  }

  cv::VideoCapture capture_;
  std::string name_;
  double max_megapixels_;
  Clock::time_point start_;
  std::int64_t count_ = 0;
};

[[noreturn]] void fail_video(const std::string& path, const std::string& reason) {
  throw Error(ErrorCode::unreadable_image, "cannot read video '" + path + "': " + reason);
}

#endif

}  // namespace

std::string without_password(const std::string& url) {
  const std::size_t scheme = url.find("://");
  if (scheme == std::string::npos) return url;
  const std::size_t host = scheme + 3;
  const std::size_t at = url.substr(0, url.find('/', host)).rfind('@');
  return at == std::string::npos || at < host ? url : url.substr(0, host) + url.substr(at + 1);
}

std::unique_ptr<FrameSource> at_its_pace(std::unique_ptr<FrameSource> video) {
  return std::make_unique<AtItsPace>(std::move(video));
}

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
  if (pixels_of(capture) > max_megapixels * 1e6) fail_video(path, "its frames are too large");
  return std::make_unique<VideoSource>(std::move(capture));
}

std::unique_ptr<FrameSource> open_camera(int number, double max_megapixels) {
  cv::VideoCapture capture(number);
  if (!capture.isOpened())
    throw Error(ErrorCode::not_found, "cannot open camera " + std::to_string(number) +
                                          ": it is not there, in use, or not permitted");
  capture.set(cv::CAP_PROP_BUFFERSIZE, 1);
  return newest_only(std::make_unique<CameraSource>(
      std::move(capture), "camera " + std::to_string(number), max_megapixels));
}

std::unique_ptr<FrameSource> open_stream(const std::string& url, double max_megapixels) {
  const std::string name = "stream '" + without_password(url) + "'";
  constexpr int kPatience = 5000;  // ms
  cv::VideoCapture capture(
      url, cv::CAP_FFMPEG,
      {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, kPatience, cv::CAP_PROP_READ_TIMEOUT_MSEC, kPatience});
  if (!capture.isOpened())
    throw Error(ErrorCode::io,
                "cannot open " + name + ": nothing answers there, or it is no video");
  return newest_only(std::make_unique<CameraSource>(std::move(capture), name, max_megapixels));
}

#else

std::unique_ptr<FrameSource> open_video(const std::string& path, double) {
  throw Error(ErrorCode::unsupported,
              "cannot read video '" + path + "': this build has no video support");
}

std::unique_ptr<FrameSource> open_camera(int number, double) {
  throw Error(ErrorCode::unsupported,
              "cannot open camera " + std::to_string(number) + ": this build has no video support");
}

std::unique_ptr<FrameSource> open_stream(const std::string&, double) {
  throw Error(ErrorCode::unsupported, "cannot open a stream: this build has no video support");
}

#endif

}  // namespace posevote
