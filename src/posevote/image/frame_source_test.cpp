#include "posevote/image/frame_source.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "posevote/core/error.hpp"
#ifdef POSEVOTE_WITH_VIDEO
#include <opencv2/videoio.hpp>
#endif

namespace posevote {
namespace {

/// Gives frames 0, 1, ... as far as it was told to, then waits to be told more.
class SteeredSource : public FrameSource {
 public:
  struct Steering {
    std::mutex mutex;
    std::condition_variable changed;
    std::int64_t allowed = 0;
    std::int64_t given = 0;
    std::int64_t end = 1 << 30;
    bool breaks = false;

    void allow(std::int64_t count) {
      std::unique_lock lock(mutex);
      allowed = count;
      changed.notify_all();
      // Asked for one more: the one before has been stored by the reader.
      changed.wait(lock, [&] { return waiting_for >= count; });
    }
    std::int64_t waiting_for = 0;
  };

  explicit SteeredSource(std::shared_ptr<Steering> steering) : steering_(std::move(steering)) {}

  std::optional<Frame> next() override {
    Steering& s = *steering_;
    std::unique_lock lock(s.mutex);
    s.waiting_for = s.given;
    s.changed.notify_all();
    s.changed.wait(lock, [&] { return s.given < s.allowed || s.given >= s.end; });
    if (s.given >= s.end) {
      if (s.breaks) throw Error(ErrorCode::io, "lost");
      return std::nullopt;
    }
    Frame frame;
    frame.number = s.given++;
    return frame;
  }

 private:
  std::shared_ptr<Steering> steering_;
};

void finish(SteeredSource::Steering& steering, bool breaks) {
  const std::lock_guard lock(steering.mutex);
  steering.end = steering.given;
  steering.breaks = breaks;
  steering.changed.notify_all();
}

TEST(NewestOnly, FramesThatNobodyTookAreDroppedAndCounted) {
  auto steering = std::make_shared<SteeredSource::Steering>();
  const auto source = newest_only(std::make_unique<SteeredSource>(steering));
  steering->allow(1);
  EXPECT_EQ(source->next()->number, 0);
  steering->allow(5);
  const auto frame = source->next();
  EXPECT_EQ(frame->number, 4);
  EXPECT_EQ(frame->dropped, 3);
  finish(*steering, false);
  EXPECT_FALSE(source->next());
  EXPECT_FALSE(source->next());
}

TEST(NewestOnly, TheNewestFrameIsHandedOutBeforeTheEnd) {
  auto steering = std::make_shared<SteeredSource::Steering>();
  const auto source = newest_only(std::make_unique<SteeredSource>(steering));
  steering->allow(3);
  finish(*steering, false);
  EXPECT_EQ(source->next()->number, 2);
  EXPECT_FALSE(source->next());
}

TEST(NewestOnly, TheErrorOfTheSourceReachesTheReceiver) {
  auto steering = std::make_shared<SteeredSource::Steering>();
  const auto source = newest_only(std::make_unique<SteeredSource>(steering));
  steering->allow(0);
  finish(*steering, true);
  EXPECT_THROW(static_cast<void>(source->next()), Error);
}

TEST(NewestOnly, CanBeLeftWhileTheSourceGoesOn) {
  auto steering = std::make_shared<SteeredSource::Steering>();
  steering->allowed = 1 << 20;
  const auto source = newest_only(std::make_unique<SteeredSource>(steering));
  EXPECT_TRUE(source->next());
}

/// Frames of a video of 100 per second that is read at once.
class QuickSource : public FrameSource {
 public:
  std::optional<Frame> next() override {
    if (count_ == 4) return std::nullopt;
    Frame frame;
    frame.number = count_;
    frame.time_s = 0.01 * static_cast<double>(count_++);
    return frame;
  }

 private:
  std::int64_t count_ = 0;
};

TEST(AtItsPace, NoFrameComesBeforeItIsDue) {
  const auto source = at_its_pace(std::make_unique<QuickSource>());
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 4; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    const auto now = std::chrono::steady_clock::now();
    EXPECT_EQ(frame->number, i);
    EXPECT_GE(now, frame->arrived);
    EXPECT_GE(now - start, std::chrono::milliseconds(10 * i));
  }
  EXPECT_FALSE(source->next());
}

#ifdef POSEVOTE_WITH_VIDEO

class Video : public testing::Test {
 protected:
  ~Video() override { std::filesystem::remove(path_); }
  std::string path_ =
      (std::filesystem::temp_directory_path() / ("video_test." + std::to_string(getpid()) + ".avi"))
          .string();
};

ErrorCode code_of(const std::string& path) {
  try {
    static_cast<void>(open_video(path));
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(path));
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::io;
}

TEST_F(Video, EveryFrameComesInOrder) {
  {
    cv::VideoWriter writer(path_, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10, {64, 48});
    for (int i = 0; i < 5; ++i) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(40 * i)));
  }
  const auto video = open_video(path_);
  EXPECT_EQ(video->length(), 5);
  for (int i = 0; i < 5; ++i) {
    const auto frame = video->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->number, i);
    EXPECT_EQ(frame->dropped, 0);
    EXPECT_NEAR(frame->time_s, i / 10.0, 1e-3);
    EXPECT_NEAR(cv::mean(frame->image)[0], 40 * i, 5);
  }
  EXPECT_FALSE(video->next());
  EXPECT_THROW(static_cast<void>(open_video(path_, 0.003)), Error);
}

TEST_F(Video, WhatIsNoVideoIsRefused) {
  EXPECT_EQ(code_of(path_), ErrorCode::unreadable_image);
  std::ofstream(path_) << "no video";
  EXPECT_EQ(code_of(path_), ErrorCode::unreadable_image);
}

TEST(Camera, OneThatIsNotThereIsAnError) {
  EXPECT_THROW(static_cast<void>(open_camera(971)), Error);
}

#endif

TEST(OpenStream, AnAddressWithoutAnswerIsAnErrorThatHidesThePassword) {
  try {
    static_cast<void>(open_stream("http://user:secret@127.0.0.1:9/video"));
    FAIL() << "it was opened";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::io);
    EXPECT_THAT(error.what(), testing::HasSubstr("127.0.0.1:9"));
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("secret")));
  }
}

#ifdef POSEVOTE_WITH_VIDEO
TEST(OpenStream, AServerThatSaysNothingIsGivenUp) {
  const int server = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(server, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(server, 8), 0);  // connections are made, and nobody answers
  getsockname(server, reinterpret_cast<sockaddr*>(&address), &size);
  const std::string host = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  for (const char* scheme : {"rtsp://", "http://"})
    EXPECT_THROW(static_cast<void>(open_stream(scheme + host + "/head")), Error) << scheme;
  close(server);
}
#endif

TEST(OpenStream, WithoutPassword) {
  EXPECT_EQ(without_password("rtsp://user:p@ss@host:554/a@b"), "rtsp://host:554/a@b");
  EXPECT_EQ(without_password("rtsp://host/a@b"), "rtsp://host/a@b");
  EXPECT_EQ(without_password("http://user@host"), "http://host");
  EXPECT_EQ(without_password("camera:0"), "camera:0");
}

}  // namespace
}  // namespace posevote
