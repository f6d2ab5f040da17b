#include "logic/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>

#include "logic/made_can.hpp"
#include "posevote/core/error.hpp"

namespace posevote::logic {
namespace {

Camera camera() {
  Camera made;
  made.size = {640, 480};
  made.matrix = {500, 0, 319.5, 0, 500, 239.5, 0, 0, 1};
  return made;
}

/// A view of 200 x 100 px in which 1 px is 1 mm when the object is 0.1 m high.
View board(double yaw_deg = std::nan("")) {
  View view;
  view.image_size = {300, 200};
  view.outline = {{50, 50}, {249, 50}, {249, 149}, {50, 149}};
  view.centre = {150, 100};
  view.yaw_deg = yaw_deg;
  return view;
}

/// What a camera sees of the board at that pose of its plane.
Detection seen(const View& view, const Pose& plane, const Camera& by, double noise_px = 0) {
  std::vector<cv::Point3d> points;
  Detection detection;
  for (int row = 0; row < 7; ++row)
    for (int column = 0; column < 13; ++column) {
      const float x = 55.F + 15 * static_cast<float>(column),
                  y = 55.F + 15 * static_cast<float>(row);
      detection.matches.push_back({{x, y}, {}});
      points.emplace_back((x - view.centre.x) * 1e-3, (y - view.centre.y) * 1e-3, 0);
    }
  cv::Vec3d rvec;
  cv::Rodrigues(plane.rotation, rvec);
  std::vector<cv::Point2d> projected;
  if (by.distortion_model == "equidistant")
    cv::fisheye::projectPoints(points, projected, rvec, plane.translation, by.matrix,
                               by.distortion);
  else
    cv::projectPoints(points, rvec, plane.translation, by.matrix, by.distortion, projected);
  cv::RNG random(7);
  for (std::size_t i = 0; i < projected.size(); ++i)
    detection.matches[i].scene = cv::Point2d(projected[i].x + random.gaussian(noise_px),
                                             projected[i].y + random.gaussian(noise_px));
  return detection;
}

Pose turned(double x_deg, double y_deg, const cv::Vec3d& translation) {
  cv::Matx33d about_x, about_y;
  cv::Rodrigues(cv::Vec3d(x_deg * CV_PI / 180, 0, 0), about_x);
  cv::Rodrigues(cv::Vec3d(0, y_deg * CV_PI / 180, 0), about_y);
  return {about_y * about_x, translation};
}

void expect_near(const Pose& a, const Pose& b, double tolerance) {
  EXPECT_LT(cv::norm(a.translation - b.translation), tolerance);
  EXPECT_LT(cv::norm(a.rotation - b.rotation), tolerance);
}

double degrees_between(const cv::Matx33d& a, const cv::Matx33d& b) {
  return std::acos(std::min((cv::trace(a * b.t()) - 1) / 2, 1.0)) * 180 / CV_PI;
}

TEST(FindPose, FindsASlantedBoardNearby) {
  const Pose truth = turned(20, -35, {0.05, -0.02, 0.4});
  const auto found = find_pose(seen(board(), truth, camera()), board(), 0.1, camera());
  ASSERT_TRUE(found);
  expect_near(found->pose, truth, 1e-3);
  EXPECT_LT(found->error_px, 0.01);
  EXPECT_FALSE(found->other);
}

TEST(FindPose, SaysThatAFarBoardMayBeMirrored) {
  const Pose truth = turned(0, 20, {0.0, 0.0, 6});
  const auto found = find_pose(seen(board(), truth, camera(), 0.5), board(), 0.1, camera());
  ASSERT_TRUE(found && found->other);
  const auto error = [&](const Pose& pose) { return cv::norm(pose.rotation - truth.rotation); };
  EXPECT_LT(std::min(error(found->pose), error(*found->other)), 0.3);
  EXPECT_NEAR(found->pose.translation[2], 6, 0.3);
}

TEST(FindPose, ScalesWithTheHeight) {
  const Pose truth = turned(0, 30, {0, 0, 0.5});
  const auto twice = find_pose(seen(board(), truth, camera()), board(), 0.2, camera());
  ASSERT_TRUE(twice);
  EXPECT_NEAR(twice->pose.translation[2], 1.0, 2e-3);
}

/// Turned anticlockwise as seen from above by 90 degrees, the front looks to the right.
TEST(FindPose, GivesTheFrameOfTheFrontWhenYawIsKnown) {
  const Pose plane = turned(0, 20, {0, 0, 0.4});
  const View side = board(90);
  const auto found = find_pose(seen(side, plane, camera()), side, 0.1, camera());
  ASSERT_TRUE(found);
  const cv::Vec3d out_of_front = found->pose.rotation * cv::Vec3d(0, 0, -1);
  const cv::Vec3d right_of_plane = plane.rotation * cv::Vec3d(1, 0, 0);
  EXPECT_GT(out_of_front.dot(right_of_plane), 0.99);
}

/// A can is no plane: taken for one, its turn is off.
TEST(FindPose, KnowsTheTurnOfACanByItsRelief) {
  const MadeCan can;
  const auto front = can.view(0, 20);
  const Relief relief = find_relief(*front, {front, can.view(30, 20), can.view(-30, 20)});
  ASSERT_TRUE(relief.known);
  for (const double yaw : {-20.0, 0.0, 15.0}) {
    const cv::Matx33d turned = MadeCan::rotation(yaw, 10);
    Detection detection;
    std::size_t i = 0;
    for (const auto& mark : can.marks) {
      if (!MadeCan::is_seen(mark, MadeCan::rotation(0, 20))) continue;
      const Keypoint& taught = front->features.keypoints[i++];
      if (!MadeCan::is_seen(mark, turned)) continue;
      const cv::Vec3d p = turned * MadeCan::place(mark) * 1e-3 + cv::Vec3d(0, 0, 0.8);
      const cv::Vec3d scene = camera().matrix * (p * (1 / p[2]));
      detection.matches.push_back({{taught.x, taught.y}, cv::Point2d(scene[0], scene[1])});
    }
    const auto found = find_pose(detection, *front, 0.16, camera(), relief);
    const auto flat = find_pose(detection, *front, 0.16, camera());
    ASSERT_TRUE(found && flat) << yaw;
    EXPECT_FALSE(found->flat);
    EXPECT_TRUE(flat->flat);
    EXPECT_LT(degrees_between(found->pose.rotation, turned), 3) << yaw;
    if (yaw == 0) {
      EXPECT_GT(degrees_between(flat->pose.rotation, turned), 15);
    }
    // Its front is a radius nearer than its middle.
    EXPECT_NEAR(found->pose.translation[2], 0.8 - 0.06, 0.015) << yaw;
  }
}

TEST(FindPose, UndoesDistortion) {
  for (const auto& [model, coefficients] : std::vector<std::pair<std::string, std::vector<double>>>{
           {"plumb_bob", {-0.3, 0.1, 0.001, -0.001, 0}},
           {"rational_polynomial", {-0.3, 0.1, 0.001, -0.001, 0, 0, 0, 0}},
           {"equidistant", {-0.01, 0.002, 0, 0}}}) {
    Camera bent = camera();
    bent.distortion_model = model;
    bent.distortion = coefficients;
    const Pose truth = turned(20, -35, {0.1, -0.05, 0.4});
    const auto found = find_pose(seen(board(), truth, bent), board(), 0.1, bent);
    ASSERT_TRUE(found) << model;
    expect_near(found->pose, truth, 2e-3);
  }
}

TEST(FindPose, UsesTheHomographyWhenThereAreNoPoints) {
  const Pose truth = turned(20, -35, {0.05, -0.02, 0.4});
  Detection detection = seen(board(), truth, camera());
  std::vector<cv::Point2f> from, to;
  for (const MatchedPoint& match : detection.matches) {
    from.push_back(match.view);
    to.push_back(match.scene);
  }
  detection.scene_from_view = cv::findHomography(from, to);
  detection.matches.clear();
  const auto found = find_pose(detection, board(), 0.1, camera());
  ASSERT_TRUE(found);
  expect_near(found->pose, truth, 5e-3);
}

TEST(FindPose, PutsTheOutlineWhereTheObjectIs) {
  const Pose truth = turned(0, 0.5, {0, 0, 0.4});
  const auto found = find_pose(seen(board(), truth, camera()), board(), 0.1, camera());
  ASSERT_TRUE(found);
  ASSERT_EQ(found->outline.size(), 4u);
  EXPECT_NEAR(cv::norm(found->outline[0] - found->outline[1]), 0.199, 1e-3);
}

TEST(FindPose, GivesNothingForPointsOnALine) {
  Detection line;
  for (int k = 0; k < 10; ++k) {
    const auto i = static_cast<float>(k);
    line.matches.push_back({{60 + i, 60 + i}, {i, i}});
  }
  EXPECT_FALSE(find_pose(line, board(), 0.1, camera()));
}

TEST(FindPose, GivesNothingWithoutCalibration) {
  const Detection detection = seen(board(), turned(0, 0, {0, 0, 1}), camera());
  EXPECT_FALSE(find_pose(detection, board(), 0.1, Camera{}));
  EXPECT_FALSE(find_pose(detection, board(), 0, camera()));
}

TEST(Undistort, RefusesModelsItDoesNotKnow) {
  Camera odd = camera();
  odd.distortion_model = "double_sphere";
  odd.distortion = {0.1, 0.2};
  EXPECT_THROW((void)undistort(odd, {{1, 1}}), Error);
  odd.distortion = {0, 0};
  EXPECT_EQ(undistort(odd, {{1, 1}})[0], cv::Point2d(1, 1));
}

TEST(ScaleCamera, KeepsRaysThroughPixelBorders) {
  const Camera half = scale_camera(camera(), {320, 240});
  EXPECT_DOUBLE_EQ(half.matrix(0, 0), 250);
  EXPECT_DOUBLE_EQ(half.matrix(0, 2), 159.5);  // the middle stays the middle
  EXPECT_EQ(scale_camera(camera(), {640, 480}).matrix, camera().matrix);
}

TEST(CropCamera, MovesTheOrigin) {
  const Camera part = crop_camera(camera(), {100, 50, 320, 240});
  EXPECT_DOUBLE_EQ(part.matrix(0, 2), 219.5);
  EXPECT_DOUBLE_EQ(part.matrix(1, 2), 189.5);
  EXPECT_EQ(part.size, cv::Size(320, 240));
}

TEST(RectifyCamera, TakesTheProjectionAndDropsTheDistortion) {
  Camera bent = camera();
  bent.distortion = {1, 2, 3};
  EXPECT_EQ(rectify_camera(bent).matrix, bent.matrix);
  bent.rectified_matrix = {400, 0, 300, 0, 400, 200, 0, 0, 1};
  EXPECT_EQ(rectify_camera(bent).matrix, bent.rectified_matrix);
  EXPECT_TRUE(rectify_camera(bent).distortion.empty());
}

TEST(OutlineAt, LiesOnTheViewingRays) {
  const auto outline = outline_at({{319.5f, 239.5f}, {819.5f, 239.5f}}, camera(), 2);
  EXPECT_LT(cv::norm(outline[0] - cv::Vec3d(0, 0, 2)), 1e-9);
  EXPECT_LT(cv::norm(outline[1] - cv::Vec3d(2, 0, 2)), 1e-9);
}

TEST(PlaceLabel, StandsAboveTheOutline) {
  const LabelPlace place = place_label({{0, 0, 4}, {2, 0, 4}, {2, 1, 4}, {0, 1, 4}});
  EXPECT_LT(cv::norm(place.position - cv::Vec3d(1, -0.1, 4)), 1e-9);
  EXPECT_DOUBLE_EQ(place.letter_height_m, 0.1);
  EXPECT_EQ(place_label({}).letter_height_m, 0);
}

TEST(Quaternion, IsOfUnitLengthAndTurnsBack) {
  EXPECT_EQ(quaternion(cv::Matx33d::eye()), cv::Vec4d(0, 0, 0, 1));
  const cv::Vec4d q = quaternion(turned(0, 90, {}).rotation);
  EXPECT_NEAR(q[1], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(q[3], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(std::abs(quaternion(turned(180, 0, {}).rotation)[0]), 1, 1e-9);
}

TEST(ParseHeights, ReadsNamesWithSpacesAndSigns) {
  const auto heights = parse_heights(" mug=0.095; blue mug = 0.1 ;a=b=2;");
  EXPECT_EQ(heights.size(), 3u);
  EXPECT_DOUBLE_EQ(heights.at("blue mug"), 0.1);
  EXPECT_DOUBLE_EQ(heights.at("a=b"), 2);
  EXPECT_TRUE(parse_heights("").empty());
}

TEST(ParseHeights, RefusesWhatIsNone) {
  for (const char* text :
       {"mug", "mug=", "=0.1", "mug=0", "mug=-1", "mug=1x", "mug=inf", "mug=nan"})
    EXPECT_THROW((void)parse_heights(text), Error) << text;
}

}  // namespace
}  // namespace posevote::logic
