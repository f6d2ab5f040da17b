#include "logic/teach_loop.hpp"

#include <gmock/gmock.h>

#include <opencv2/imgproc.hpp>
#include <thread>

namespace posevote::logic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Frame {
  cv::Mat pixels;
  double time_s = 0;
  bool damaged = false;

  cv::Mat picture() const {
    if (damaged) throw Error(ErrorCode::unreadable_image, "damaged");
    return pixels;
  }
};

Lesson whole() {
  Lesson lesson;
  lesson.object = "mug";
  lesson.method = "whole";
  return lesson;
}

/// A session that takes the first picture at rest, and a loop around it.
struct Setting {
  Latest<Frame> frames;
  std::vector<std::string> steps;
  bool cancel = false, capture = false;
  std::function<void()> when_reported;
  TeachSession session;
  TeachLoop<Frame> loop;

  explicit Setting(const Lesson& lesson = whole())
      : session(lesson, {}, [](const ViewSource&) { return TaughtPicture(); }),
        loop{frames,
             "/camera",
             60,
             [](const Frame& frame) { return frame.time_s; },
             [this] { return std::exchange(capture, false); },
             [this] { return cancel; },
             [this](const TeachProgress& progress, const Frame*) {
               steps.push_back(progress.step);
               if (when_reported) when_reported();
             }} {}
};

/// Sends frames until it is destroyed.
class Camera {
 public:
  explicit Camera(Latest<Frame>& frames, bool damaged_first = false)
      : thread_([this, &frames, damaged_first] {
          if (damaged_first) frames.offer({{}, 0, true});
          for (double t = 0; !stopped_; t += 0.1) {
            frames.offer(
                {cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(100)), t, damaged_first && t < 1});
            std::this_thread::yield();
          }
        }) {}
  ~Camera() {
    stopped_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> stopped_{false};
  std::thread thread_;
};

TEST(TeachLoop, RunsUntilTheSessionIsDone) {
  Setting setting;
  const Camera camera(setting.frames);
  EXPECT_EQ(setting.loop.run(setting.session).views_taken, 1);
  EXPECT_THAT(setting.steps, ElementsAre("object", "done"));
}

TEST(TeachLoop, PassesOverDamagedFrames) {
  Setting setting;
  const Camera camera(setting.frames, true);
  EXPECT_EQ(setting.loop.run(setting.session).views_taken, 1);
}

TEST(TeachLoop, EndsWhenCancelled) {
  Setting setting;
  setting.when_reported = [&] { setting.cancel = true; };
  EXPECT_EQ(setting.loop.run(setting.session).step, "object");
  EXPECT_THAT(setting.steps, ElementsAre("object"));
}

TEST(TeachLoop, GivesUpWithoutPictures) {
  Setting setting;
  setting.loop.patience_s = 1e-3;
  try {
    (void)setting.loop.run(setting.session);
    FAIL() << "waited for ever";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/camera"));
    EXPECT_THAT(error.what(), HasSubstr("'object'"));
  }
}

TEST(TeachLoop, CapturesWhenAskedTo) {
  Lesson manual = whole();
  manual.manual = true;
  Setting setting(manual);
  setting.capture = true;
  const Camera camera(setting.frames);
  EXPECT_EQ(setting.loop.run(setting.session).views_taken, 1);
}

}  // namespace
}  // namespace posevote::logic
