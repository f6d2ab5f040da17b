#include "live/camera.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <thread>
#ifdef POSEVOTE_WITH_VIDEO
#include <opencv2/videoio.hpp>
#endif

#include "http/problem.hpp"
#include "posevote/core/error.hpp"

namespace posevote::server {
namespace {

namespace fs = std::filesystem;

class CameraTest : public testing::Test {
 protected:
  CameraTest() { fs::create_directory(folder_); }
  ~CameraTest() override { fs::remove_all(folder_); }

  /// A plain picture of this brightness.
  void show(int name, int brightness) const {
    cv::imwrite(folder_ + "/" + std::to_string(name) + ".png",
                cv::Mat(40, 60, CV_8UC3, cv::Scalar::all(brightness)));
  }

  /// Asks again at every ring; false after some minutes: the machine may be busy.
  bool until(const std::function<bool()>& condition) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    std::uint64_t seen = bell_.rings();
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      seen = bell_.wait(seen, std::chrono::milliseconds(100));
    }
    return true;
  }

  Bell bell_;
  std::string folder_ =
      (fs::temp_directory_path() / ("posevote-camera-" + std::to_string(getpid()))).string();
};

TEST_F(CameraTest, AFolderIsShownAgainAndAgain) {
  show(1, 50);
  show(2, 200);
  PostedFrames posted;
  const auto source = open_source(folder_, {100, 25}, posted);
  for (const int brightness : {50, 200, 50, 200})
    EXPECT_EQ(source->next()->image.at<cv::Vec3b>(0, 0)[0], brightness);
}

TEST_F(CameraTest, ADamagedPictureIsLeftOutAndAFolderOfThemIsAnError) {
  show(1, 50);
  std::ofstream(folder_ + "/2.png") << "no picture";
  PostedFrames posted;
  const auto source = open_source(folder_, {100, 25}, posted);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(source->next()->image.at<cv::Vec3b>(0, 0)[0], 50);
  fs::remove(folder_ + "/1.png");
  EXPECT_THROW(static_cast<void>(source->next()), Error);
}

TEST_F(CameraTest, AFolderThatIsGoneIsSaidToBeGone) {
  show(1, 50);
  PostedFrames posted;
  const auto source = open_source(folder_, {100, 25}, posted);
  fs::remove_all(folder_);
  try {
    static_cast<void>(source->next());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), "folder '" + folder_ + "' is not there any more");
  }
}

#ifdef POSEVOTE_WITH_VIDEO
TEST_F(CameraTest, AVideoIsShownAgainAndAgain) {
  const std::string path = folder_ + "/clip.avi";
  {
    cv::VideoWriter writer(path, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 100, {64, 48});
    for (const int brightness : {50, 200})
      writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(brightness)));
  }
  PostedFrames posted;
  const auto source = open_source(path, {100, 25}, posted);
  std::int64_t number = 0;
  for (const int brightness : {50, 200, 50, 200}) {
    const auto frame = source->next();
    EXPECT_NEAR(frame->image.at<cv::Vec3b>(0, 0)[0], brightness, 5);
    EXPECT_EQ(frame->number, number++);
  }
}
#endif

TEST_F(CameraTest, NamesOfSources) {
  EXPECT_EQ(parse_source("0").name, "camera:0");
  EXPECT_EQ(parse_source("client").name, "client");
  const SourceChoice stream = parse_source("rtsp://me:secret@robot/head");
  EXPECT_EQ(stream.name, "rtsp://robot/head");
  EXPECT_EQ(stream.address, "rtsp://me:secret@robot/head");
  PostedFrames posted;
  EXPECT_THROW(static_cast<void>(open_source(folder_ + "/none", {}, posted)), Error);
  EXPECT_THROW(static_cast<void>(open_source("camera:x", {}, posted)), Error);
  fs::create_symlink("/dev/video971", folder_ + "/usb-camera");
  for (const auto& [address, what] : std::map<std::string, std::string>{
           {folder_ + "/usb-camera", "camera 971"}, {"/dev/v4l/by-id/none", "/dev/v4l/by-id/none"}})
    try {
      static_cast<void>(open_source(address, {}, posted));
      FAIL() << address;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(what));
      EXPECT_THAT(error.what(), testing::HasSubstr("camera"));
    }
}

TEST_F(CameraTest, FramesAreNumberedAndStateIsTold) {
  show(1, 50);
  Camera camera({parse_source(folder_)}, {100, 25}, bell_);
  ASSERT_TRUE(until([&] { return camera.newest() && camera.newest()->number() >= 2; }));
  EXPECT_EQ(camera.status().state, CameraState::running);
  EXPECT_EQ(camera.newest()->source(), folder_);
  fs::remove_all(folder_);
  ASSERT_TRUE(until([&] { return camera.status().state == CameraState::lost; }));
  EXPECT_THAT(camera.status().message, testing::HasSubstr(folder_));
  fs::create_directory(folder_);
  show(1, 60);
  EXPECT_TRUE(until([&] { return camera.status().state == CameraState::running; }));
}

/// A camera's driver that does as it is told.
class Driver {
 public:
  enum Mode { gives, fails, hangs, one_hangs };

  void be(Mode mode) {
    const std::lock_guard lock(mutex_);
    mode_ = mode;
    told_.notify_all();
  }
  void release() {
    const std::lock_guard lock(mutex_);
    released_ = true;
    told_.notify_all();
  }
  int hanging() const {
    const std::lock_guard lock(mutex_);
    return hanging_;
  }

  /// With `one_hangs` the next one hangs for good, and all others get frames.
  void work() {
    std::unique_lock lock(mutex_);
    const bool for_good = mode_ == one_hangs;
    if (for_good) mode_ = gives;
    ++hanging_;
    told_.wait(lock, [&] { return released_ || (!for_good && mode_ != hangs); });
    --hanging_;
    if (released_ || mode_ == fails) throw Error(ErrorCode::io, "the cable is loose");
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable told_;
  Mode mode_ = gives;
  int hanging_ = 0;
  bool released_ = false;
};

class DrivenSource : public FrameSource {
 public:
  explicit DrivenSource(std::shared_ptr<Driver> driver) : driver_(std::move(driver)) {
    driver_->work();
  }
  std::optional<Frame> next() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));  // its rate
    driver_->work();
    Frame frame;
    frame.image = cv::Mat(3, 4, CV_8UC3, cv::Scalar::all(9));
    frame.number = number_ += 2;
    frame.dropped = 1;
    return frame;
  }

 private:
  std::shared_ptr<Driver> driver_;
  std::int64_t number_ = -1;
};

class DrivenCamera : public CameraTest {
 protected:
  DrivenCamera() { show(1, 50); }
  ~DrivenCamera() override {
    driver_->release();
    camera_.stop();
  }
  bool becomes(CameraState state) const {
    return until([&] { return camera_.status().state == state; });
  }

  std::shared_ptr<Driver> driver_ = std::make_shared<Driver>();
  Camera camera_{{{"camera", "camera"}, parse_source(folder_)},
                 {100, 25, 0.1},
                 bell_,
                 [driver = driver_](const std::string& address, const SourceOptions& options,
                                    PostedFrames& posted) -> std::unique_ptr<FrameSource> {
                   if (address == "camera") return std::make_unique<DrivenSource>(driver);
                   return open_source(address, options, posted);
                 }};
};

TEST_F(DrivenCamera, DroppedFramesAreCounted) {
  ASSERT_TRUE(until([&] { return camera_.status().frames >= 3; }));
  const CameraStatus status = camera_.status();
  EXPECT_EQ(status.dropped, status.frames);
}

TEST_F(DrivenCamera, ItFailsAndComesBack) {
  ASSERT_TRUE(becomes(CameraState::running));
  driver_->be(Driver::fails);
  ASSERT_TRUE(becomes(CameraState::lost));
  EXPECT_EQ(camera_.status().message, "the cable is loose");
  driver_->be(Driver::gives);
  EXPECT_TRUE(becomes(CameraState::running));
  EXPECT_EQ(camera_.status().message, "");
}

TEST_F(DrivenCamera, ItHangsAndComesBack) {
  ASSERT_TRUE(becomes(CameraState::running));
  driver_->be(Driver::hangs);
  ASSERT_TRUE(becomes(CameraState::lost));
  EXPECT_THAT(camera_.status().message, testing::HasSubstr("no frame has come"));
  driver_->be(Driver::gives);
  EXPECT_TRUE(becomes(CameraState::running));
}

TEST_F(DrivenCamera, AnotherAttemptDoesNotWaitForTheOneThatHangs) {
  ASSERT_TRUE(becomes(CameraState::running));
  driver_->be(Driver::one_hangs);
  ASSERT_TRUE(becomes(CameraState::lost));
  EXPECT_TRUE(becomes(CameraState::running));
  EXPECT_EQ(driver_->hanging(), 1);
}

TEST_F(DrivenCamera, AnotherSourceDoesNotWaitForTheOneThatHangs) {
  driver_->be(Driver::hangs);
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(becomes(CameraState::lost));
    ASSERT_TRUE(until([&] { return driver_->hanging() == 2; })) << "it is tried again";
    camera_.select(folder_);
    ASSERT_TRUE(becomes(CameraState::running));
    EXPECT_EQ(driver_->hanging(), 2) << "but not without end";
    camera_.select("camera");
  }
  driver_->be(Driver::gives);
  EXPECT_TRUE(becomes(CameraState::running));
  EXPECT_EQ(camera_.newest()->source(), "camera");
}

TEST_F(CameraTest, PostedFramesOnlyWhileTheyAreTheSource) {
  show(1, 50);
  Camera camera({parse_source(folder_)}, {100, 25}, bell_);
  const cv::Mat picture(30, 30, CV_8UC3, cv::Scalar::all(9));
  EXPECT_THROW(camera.post(picture), Problem);
  EXPECT_THROW(camera.select("/etc"), Problem);
  camera.select("client");
  camera.post(picture);
  ASSERT_TRUE(until([&] { return camera.newest() && camera.newest()->source() == "client"; }));
  EXPECT_EQ(camera.newest()->image().cols, 30);
}

TEST_F(CameraTest, FramesAreReducedForStreamsOnce) {
  LiveOptions options;
  options.stream_width = 100;
  const LiveFrame frame(cv::Mat(300, 400, CV_8UC3, cv::Scalar::all(9)), 7, 1.5, "x", options);
  const cv::Mat small = cv::imdecode(frame.stream_jpeg(), cv::IMREAD_COLOR);
  EXPECT_EQ(small.size(), cv::Size(100, 75));
  EXPECT_EQ(&frame.stream_jpeg(), &frame.stream_jpeg());
}

}  // namespace
}  // namespace posevote::server
