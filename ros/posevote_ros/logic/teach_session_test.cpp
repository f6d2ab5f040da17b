#include "logic/teach_session.hpp"

#include <gmock/gmock.h>

#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"

namespace posevote::logic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

cv::Mat scene(int box_at = -1) {
  cv::Mat picture(120, 160, CV_8UC3, cv::Scalar::all(100));
  if (box_at >= 0) cv::rectangle(picture, {box_at, 40, 40, 40}, {0, 0, 255}, cv::FILLED);
  return picture;
}

Lesson lesson(int views, double turn_deg = 0) {
  Lesson made;
  made.object = "mug";
  made.views = views;
  made.turn_deg = turn_deg;
  return made;
}

/// Takes notes of what it is asked to teach.
struct Teacher {
  std::vector<ViewSource> sources;
  int refuse_first = 0;

  TeachView view() {
    return [this](const ViewSource& source) {
      if (refuse_first-- > 0) throw Error(ErrorCode::unusable_view, "too dark");
      sources.push_back(source);
      TaughtPicture taught;
      taught.features = 50;
      taught.mask = cv::Mat::zeros(source.picture.size(), CV_8U);
      taught.mask(cv::Rect(0, 0, 10, 10)) = 255;
      return taught;
    };
  }
};

/// Shows a picture long enough to be taken; says how often progress was reported.
int show(TeachSession& session, const cv::Mat& picture, double& time_s) {
  int reports = 0;
  for (int i = 0; i < 15; ++i) reports += session.offer(picture, time_s += 0.1);
  return reports;
}

TEST(TeachSession, TakesTheEmptySceneThenAViewAfterEachChange) {
  Teacher teacher;
  TeachSession session(lesson(2, 36), {}, teacher.view());
  double t = 0;
  EXPECT_EQ(session.progress().step, "background");
  EXPECT_EQ(show(session, scene(), t), 1);
  EXPECT_EQ(session.progress().step, "object");
  EXPECT_EQ(show(session, scene(), t), 0);  // nothing was put there
  EXPECT_EQ(show(session, scene(40), t), 1);
  EXPECT_EQ(session.progress().step, "turn");
  EXPECT_EQ(session.progress().features, 50);
  EXPECT_EQ(show(session, scene(40), t), 0);
  EXPECT_EQ(show(session, scene(60), t), 1);
  EXPECT_TRUE(session.finished());
  ASSERT_EQ(teacher.sources.size(), 2u);
  EXPECT_EQ(cv::norm(teacher.sources[1].background, scene(), cv::NORM_INF), 0);
  EXPECT_THAT(session.progress().yaws_deg, ElementsAre(0, 36));
}

TEST(TeachSession, WaitsWhileSomethingMoves) {
  Teacher teacher;
  TeachSession session(lesson(1), {}, teacher.view());
  double t = 0;
  (void)show(session, scene(), t);
  for (int i = 0; i < 30; ++i) EXPECT_FALSE(session.offer(scene(3 * i), t += 0.1));
  EXPECT_TRUE(teacher.sources.empty());
}

TEST(TeachSession, RefusesWithAdviceAndWaitsForAChange) {
  Teacher teacher;
  teacher.refuse_first = 1;
  TeachSession session(lesson(1), {}, teacher.view());
  double t = 0;
  (void)show(session, scene(), t);
  EXPECT_EQ(show(session, scene(40), t), 1);
  EXPECT_THAT(session.progress().advice, ElementsAre("too dark"));
  EXPECT_EQ(session.progress().views_refused, 1);
  EXPECT_EQ(session.progress().step, "object");
  EXPECT_EQ(show(session, scene(80), t), 1);
  EXPECT_TRUE(session.finished());
}

TEST(TeachSession, NeedsNoBackgroundForABox) {
  Teacher teacher;
  Lesson boxed = lesson(1);
  boxed.method = "box";
  boxed.box = {10, 10, 50, 50};
  TeachSession session(boxed, {}, teacher.view());
  double t = 0;
  EXPECT_EQ(show(session, scene(), t), 1);
  EXPECT_TRUE(session.finished());
  EXPECT_EQ(teacher.sources[0].roi, boxed.box);
  EXPECT_TRUE(teacher.sources[0].background.empty());
  EXPECT_TRUE(std::isnan(teacher.sources[0].yaw_deg));
}

TEST(TeachSession, TakesPicturesOnlyWhenAskedIfManual) {
  Teacher teacher;
  Lesson manual = lesson(1);
  manual.manual = true;
  TeachSession session(manual, {}, teacher.view());
  double t = 0;
  EXPECT_EQ(show(session, scene(), t), 0);
  session.capture();
  EXPECT_TRUE(session.offer(scene(), t));
  EXPECT_EQ(show(session, scene(40), t), 0);
  session.capture();
  EXPECT_TRUE(session.offer(scene(40), t));
  EXPECT_TRUE(session.finished());
}

TEST(TeachSession, DarkensWhatIsNotTheObject) {
  Teacher teacher;
  TeachSession session(lesson(1), {}, teacher.view());
  double t = 0;
  (void)show(session, scene(), t);
  (void)show(session, scene(80), t);
  const cv::Mat preview = session.progress().preview;
  EXPECT_EQ(preview.at<cv::Vec3b>(5, 5), cv::Vec3b(100, 100, 100));
  EXPECT_EQ(preview.at<cv::Vec3b>(100, 5), cv::Vec3b(30, 30, 30));
}

TEST(TeachSession, LetsOtherErrorsThrough) {
  TeachSession session(lesson(1), {}, [](const ViewSource&) -> TaughtPicture {
    throw Error(ErrorCode::io, "disk full");
  });
  double t = 0;
  (void)show(session, scene(), t);
  EXPECT_THROW((void)show(session, scene(40), t), Error);
}

TEST(TeachPictures, TeachesAllAndCountsTheRefused) {
  Teacher teacher;
  teacher.refuse_first = 1;
  std::vector<std::string> steps;
  const auto done = teach_pictures(lesson(1, 30), {scene(0), scene(40), scene(80)}, scene(),
                                   teacher.view(), [&](const TeachProgress& progress) {
                                     steps.push_back(progress.step);
                                     return true;
                                   });
  EXPECT_THAT(steps, ElementsAre("object", "object", "done"));
  EXPECT_EQ(done.views_taken, 2);
  EXPECT_EQ(done.views_refused, 1);
  EXPECT_THAT(done.yaws_deg, ElementsAre(30, 60));  // a refused picture keeps its turn
}

TEST(TeachPictures, EndsWhenAskedTo) {
  Teacher teacher;
  (void)teach_pictures(lesson(1), {scene(0), scene(40)}, scene(), teacher.view(),
                       [](const TeachProgress&) { return false; });
  EXPECT_EQ(teacher.sources.size(), 1u);
}

TEST(TeachPictures, NeedsTheEmptyScene) {
  Teacher teacher;
  EXPECT_THROW((void)teach_pictures(lesson(1), {scene(0)}, cv::Mat(), teacher.view(),
                                    [](const TeachProgress&) { return true; }),
               Error);
}

TEST(CheckLesson, SaysWhatIsWrong) {
  const auto reason = [](const Lesson& wrong) -> std::string {
    try {
      check_lesson(wrong);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(reason(lesson(1)), "");
  EXPECT_THAT(reason(lesson(0)), HasSubstr("views"));
  Lesson wrong = lesson(1);
  wrong.method = "magic";
  EXPECT_THAT(reason(wrong), HasSubstr("magic"));
  wrong.method = "box";
  EXPECT_THAT(reason(wrong), HasSubstr("box"));
  wrong = lesson(1, std::nan(""));
  EXPECT_THAT(reason(wrong), HasSubstr("turns"));
  wrong = lesson(1);
  wrong.object = "";
  EXPECT_NE(reason(wrong), "");
}

}  // namespace
}  // namespace posevote::logic
