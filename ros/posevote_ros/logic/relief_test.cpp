#include "logic/relief.hpp"

#include <gtest/gtest.h>

#include "logic/made_can.hpp"

namespace posevote::logic {
namespace {

const double nan = std::nan("");

TEST(FindRelief, BulgesAsACanDoesAndKnowsTheTilt) {
  const MadeCan can;
  const auto front = can.view(0, 20);
  // The turned ones were taken from elsewhere: smaller, and not in the middle.
  const Relief relief =
      find_relief(*front, {front, can.view(30, 20, 0.9, {150, 120}), can.view(-30, 20, 1.1)});
  ASSERT_TRUE(relief.known);
  EXPECT_NEAR(relief.tilt_deg, 20, 3);
  // At 2/3 of its radius a can's surface is a quarter of it further away than in the middle.
  for (const double x : {-40.0, 40.0})
    EXPECT_NEAR(relief.depth_px({200 + x, 200}), MadeCan::radius / 4, 4) << x;
  EXPECT_EQ(relief.depth_px({200, 200}), 0);
  // Seen from above, its upper end is nearer: tan 20 degrees of 40 px.
  EXPECT_NEAR(relief.depth_px({200, 160}), -14.6, 3);
}

TEST(FindRelief, IsTheSameEveryTime) {
  const MadeCan can;
  const std::vector<std::shared_ptr<const View>> views = {can.view(0, 10), can.view(40, 10)};
  EXPECT_EQ(find_relief(*views[0], views).shape, find_relief(*views[0], views).shape);
}

TEST(FindRelief, TurnsArePassedOverThatTellNothing) {
  const MadeCan can;
  const auto front = can.view(0, 20);
  for (const double yaw : {0.0, 4.0, 61.0, 180.0, nan})
    EXPECT_FALSE(find_relief(*front, {front, can.view(yaw, 20)}).known) << yaw;
  EXPECT_TRUE(find_relief(*front, {front, can.view(330, 20)}).known);
  const auto unknown = can.view(nan, 20);
  EXPECT_FALSE(find_relief(*unknown, {unknown, can.view(30, 20)}).known);
}

TEST(FindRelief, IsNotKnownWhenFeaturesHaveNothingInCommon) {
  MadeCan can;
  const auto front = can.view(0, 20);
  const auto other = can.view(30, 20);
  cv::RNG(9).fill(other->features.descriptors, cv::RNG::NORMAL, 0, 0.125);
  EXPECT_FALSE(find_relief(*front, {front, other}).known);
  can.marks = {};
  EXPECT_FALSE(find_relief(*front, {front, can.view(30, 20)}).known);
}

TEST(FindRelief, IsNotKnownWhenTurnsHaveTheWrongSign) {
  const MadeCan can;
  const auto front = can.view(0, 20), turned = can.view(30, 20);
  turned->yaw_deg = -30;
  EXPECT_FALSE(find_relief(*front, {front, turned}).known);
}

TEST(ReliefCache, SeesWhenViewsAreAdded) {
  const MadeCan can;
  ObjectModel object{"can", {can.view(0, 20)}};
  ReliefCache cache;
  EXPECT_FALSE(cache.find(object, *object.views[0]).known);
  object.views.push_back(can.view(30, 20));
  EXPECT_TRUE(cache.find(object, *object.views[0]).known);
  EXPECT_TRUE(cache.find(object, *object.views[1]).known);
}

}  // namespace
}  // namespace posevote::logic
