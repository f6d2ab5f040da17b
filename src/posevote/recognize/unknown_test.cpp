#include "posevote/recognize/unknown.hpp"

#include <gtest/gtest.h>

namespace posevote {
namespace {

constexpr int kWidth = 640, kHeight = 480;

/// Key points 5 px apart in a rectangle.
void fill(Features& scene, cv::Rect area) {
  for (int y = area.y; y < area.br().y; y += 5)
    for (int x = area.x; x < area.br().x; x += 5)
      scene.keypoints.push_back({static_cast<float>(x), static_cast<float>(y), 2, 0, 1, 1});
}

Detection at(cv::Rect2f area) {
  Detection detection;
  detection.outline = {area.tl(), {area.br().x, area.y}, area.br(), {area.x, area.br().y}};
  return detection;
}

double overlap(const cv::Rect2f& a, const cv::Rect2f& b) {
  return (a & b).area() / (a | b).area();
}

TEST(FindUnknown, TexturedPartsAreReportedTheLargerFirst) {
  Features scene;
  fill(scene, {400, 300, 90, 80});
  fill(scene, {60, 80, 160, 140});
  const auto found = find_unknown(scene, {kWidth, kHeight}, {});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_GT(overlap(found[0].box, {60, 80, 160, 140}), 0.7);
  EXPECT_GT(overlap(found[1].box, {400, 300, 90, 80}), 0.6);
  EXPECT_NEAR(found[0].features, 32 * 28, 60);
}

TEST(FindUnknown, WhatADetectionExplainsIsKnown) {
  Features scene;
  fill(scene, {60, 80, 160, 140});
  fill(scene, {400, 300, 90, 80});
  const auto found = find_unknown(scene, {kWidth, kHeight}, {at({55, 75, 170, 150})});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_GT(found[0].box.x, 380);
}

TEST(FindUnknown, FewFeaturesAndSmallSpotsAreNothing) {
  Features scene;
  fill(scene, {300, 200, 20, 20});
  for (int i = 0; i < 60; ++i)
    scene.keypoints.push_back(
        {static_cast<float>(i * 97 % kWidth), static_cast<float>(i * 61 % kHeight), 2, 0, 1, 1});
  EXPECT_TRUE(find_unknown(scene, {kWidth, kHeight}, {}).empty());
  EXPECT_TRUE(find_unknown({}, {1, 1}, {}).empty());
  EXPECT_TRUE(find_unknown({}, {}, {}).empty());
}

}  // namespace
}  // namespace posevote
