// With structs that have the messages' fields: the real ones are filled where ROS is.
#include "logic/fill_message.hpp"

#include <gmock/gmock.h>

#include <array>

#include "logic/serve.hpp"
#include "posevote/core/error.hpp"

namespace posevote::logic {
namespace {

using testing::ElementsAre;

struct Header {
  int stamp = 0;
};
struct Image {
  Header header;
  std::uint32_t width = 0, height = 0, step = 0;
  std::string encoding;
  std::uint8_t is_bigendian = 0;
  std::vector<std::uint8_t> data;
};
struct Point {
  double x = 0, y = 0, z = 0;
};
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 0;
};
struct PoseMessage {
  Point position;
  Quaternion orientation;
};
struct Point2 {
  float x, y;
};
struct Box {
  float x, y, width, height;
};
struct DetectionMessage {
  std::string object, view, frame;
  std::vector<std::string> alternatives;
  float confidence, probability, log10_false_alarms, pose_error_px;
  std::uint32_t inliers, features_in_area, track;
  std::array<double, 9> homography;
  std::vector<Point2> outline;
  Box box;
  bool confirmed, has_pose, pose_ambiguous, pose_flat;
  PoseMessage pose, other_pose;
};
struct DetectionArray {
  std::uint32_t image_width, image_height, features, dropped;
  float time_ms;
  std::vector<DetectionMessage> detections;
};
struct Colour {
  float r, g, b, a;
};
struct Marker {
  enum { CUBE = 1, LINE_STRIP = 4, TEXT_VIEW_FACING = 9, ADD = 0, DELETEALL = 3 };
  Header header;
  std::string ns, text;
  int id = 0, type = 0, action = ADD;
  PoseMessage pose;
  Point scale;
  Colour color;
  std::vector<Point> points;
};
struct Markers {
  std::vector<Marker> markers;
};
struct Transform {
  Header header;
  std::string child_frame_id;
  struct {
    Point translation;
    Quaternion rotation;
  } transform;
};

/// A mug with a pose, a book without one.
Findings findings() {
  Findings made;
  made.result.image_size = {640, 480};
  made.result.time_ms.total = 12;
  FoundObject mug;
  mug.detection.object = "mug";
  mug.detection.confidence = 0.5;
  mug.detection.scene_from_view = {1, 2, 3, 4, 5, 6, 7, 8, 1};
  mug.detection.outline = {{1, 2}, {3, 4}, {5, 6}};
  mug.detection.box = {1, 2, 30, 40};
  mug.track = {7, 1, true};
  mug.frame = "posevote/mug_1";
  mug.pose.emplace();
  mug.pose->pose.translation = {1, 2, 3};
  mug.pose->other = Pose{};
  mug.outline = {{0, 0, 2}, {1, 0, 2}, {1, 1, 2}};
  FoundObject book;
  book.detection.object = "book";
  made.objects = {mug, book};
  return made;
}

TEST(FillDetections, CopiesEverything) {
  DetectionArray message;
  fill_detections(message, findings(), 4);
  EXPECT_EQ(message.image_width, 640u);
  EXPECT_EQ(message.dropped, 4u);
  ASSERT_EQ(message.detections.size(), 2u);
  const DetectionMessage& mug = message.detections[0];
  EXPECT_EQ(mug.object, "mug");
  EXPECT_THAT(mug.homography, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 1));
  EXPECT_EQ(mug.outline[2].y, 6);
  EXPECT_EQ(mug.box.height, 40);
  EXPECT_EQ(mug.track, 7u);
  EXPECT_TRUE(mug.has_pose && mug.pose_ambiguous && mug.pose_flat && mug.confirmed);
  EXPECT_EQ(mug.pose.position.z, 3);
  EXPECT_EQ(mug.pose.orientation.w, 1);
}

/// Other programs choke on quaternions of zeros.
TEST(FillDetections, GivesUnitQuaternionsWhereThereIsNoPose) {
  DetectionArray message;
  fill_detections(message, findings(), 0);
  const DetectionMessage& book = message.detections[1];
  EXPECT_FALSE(book.has_pose || book.pose_ambiguous || book.pose_flat);
  EXPECT_EQ(book.pose.orientation.w, 1);
  EXPECT_EQ(book.other_pose.orientation.w, 1);
}

TEST(FillMarkers, DeletesThenDrawsWhatHasAnOutline) {
  Markers message;
  fill_markers(message, findings(), Header{5});
  ASSERT_EQ(message.markers.size(), 3u);
  EXPECT_EQ(message.markers[0].action, Marker::DELETEALL);
  EXPECT_EQ(message.markers[1].points.size(), 4u);  // closed
  EXPECT_EQ(message.markers[1].action, Marker::ADD);
  EXPECT_EQ(message.markers[2].text, "mug");
  for (const Marker& marker : message.markers) EXPECT_EQ(marker.header.stamp, 5);
}

TEST(FillTransforms, AreThoseOfConfirmedObjectsWithAPose) {
  std::vector<Transform> message;
  Findings found = findings();
  fill_transforms(message, found, Header{5});
  ASSERT_EQ(message.size(), 1u);
  EXPECT_EQ(message[0].child_frame_id, "posevote/mug_1");
  EXPECT_EQ(message[0].transform.translation.x, 1);
  message.clear();
  found.objects[0].track.confirmed = false;
  fill_transforms(message, found, Header{});
  EXPECT_TRUE(message.empty());
}

TEST(FillImage, GoesThereAndBack) {
  cv::Mat picture(3, 4, CV_8UC3);
  cv::randu(picture, 0, 255);
  Image message;
  fill_image(message, picture(cv::Rect(1, 1, 2, 2)));
  EXPECT_EQ(message.encoding, "bgr8");
  EXPECT_EQ(message.data.size(), 12u);
  const cv::Mat back = to_picture(view_of(message));
  EXPECT_EQ(cv::norm(back, picture(cv::Rect(1, 1, 2, 2)), cv::NORM_INF), 0);
}

struct Goal {
  std::string object = "mug", method;
  Box box{1, 2, 30, 40};
  std::uint32_t views = 0;
  float first_yaw_deg = 10, turn_deg = 36;
  bool manual = true;
};

TEST(ToLesson, FillsInWhatIsLeftOpen) {
  Goal goal;
  const Lesson lesson = to_lesson(goal);
  EXPECT_EQ(lesson.method, "background");
  EXPECT_EQ(lesson.views, 1);
  EXPECT_EQ(lesson.box, cv::Rect(1, 2, 30, 40));
  EXPECT_EQ(lesson.turn_deg, 36);
  EXPECT_TRUE(lesson.manual);
  goal.method = "whole";
  goal.views = 4294967295u;
  EXPECT_EQ(to_lesson(goal).method, "whole");
  EXPECT_THROW(check_lesson(to_lesson(goal)), Error);
}

struct Result {
  bool success = false;
  std::string message;
  std::uint32_t views_added = 9, views_known = 9, views_refused = 9;
};

TEST(FillResult, IsASuccessWhenViewsWereTaken) {
  TeachProgress progress;
  progress.step = "done";
  progress.views_refused = 2;
  progress.advice = {"Too dark.", "Too small."};
  Result result;
  fill_result(result, progress);
  EXPECT_FALSE(result.success);
  EXPECT_EQ(result.message, "Too dark. Too small.");
  EXPECT_EQ(result.views_refused, 2u);
  progress.views_known = 1;
  fill_result(result = {}, progress);
  EXPECT_TRUE(result.success);
}

struct Response {
  bool success = false;
  std::string message;
};

TEST(Serve, TurnsErrorsIntoAnswers) {
  Response response;
  serve(0, response, [](int, Response&) { throw Error(ErrorCode::not_found, "no such object"); });
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.message, "no such object");
  Response good;
  serve(0, good, [](int, Response&) {});
  EXPECT_TRUE(good.success);
}

}  // namespace
}  // namespace posevote::logic
