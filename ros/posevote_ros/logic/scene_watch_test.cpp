#include "logic/scene_watch.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"

namespace posevote::logic {
namespace {

cv::Mat table(int brightness = 100) {
  return cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(brightness));
}

cv::Mat with_box(int x, int brightness = 100) {
  cv::Mat picture = table(brightness);
  cv::rectangle(picture, {x, 200, 80, 80}, {0, 0, 255}, cv::FILLED);
  return picture;
}

TEST(SceneWatch, RestsAfterTheTimeItWasGiven) {
  SceneWatch watch;
  EXPECT_FALSE(watch.at_rest());
  watch.add(table(), 10);
  EXPECT_FALSE(watch.at_rest());
  watch.add(table(), 10.9);
  EXPECT_FALSE(watch.at_rest());
  watch.add(table(), 11);
  EXPECT_TRUE(watch.at_rest());
}

TEST(SceneWatch, SeesMotion) {
  SceneWatch watch;
  watch.add(with_box(100), 0);
  watch.add(with_box(100), 2);
  ASSERT_TRUE(watch.at_rest());
  watch.add(with_box(140), 3);
  EXPECT_FALSE(watch.at_rest());
}

TEST(SceneWatch, SeesMotionTooSlowForTwoPictures) {
  SceneWatch watch;
  for (int i = 0; i < 40; ++i) watch.add(with_box(100 + i), 0.1 * i);
  EXPECT_FALSE(watch.at_rest());
}

TEST(SceneWatch, IgnoresNoiseAndExposure) {
  SceneWatch watch;
  cv::RNG random(3);
  watch.add(table(), 0);
  watch.remember();
  for (int i = 1; i <= 20; ++i) {
    cv::Mat noise(480, 640, CV_16SC3), noisy;
    random.fill(noise, cv::RNG::NORMAL, 0, 6);
    cv::add(table(100 + 2 * i), noise, noisy, cv::noArray(), CV_8U);
    watch.add(noisy, 0.1 * i);
  }
  EXPECT_TRUE(watch.at_rest());
  EXPECT_FALSE(watch.has_changed());
}

TEST(SceneWatch, ComparesWithWhatItRemembers) {
  SceneWatch watch;
  EXPECT_TRUE(watch.has_changed());
  watch.add(table(), 0);
  EXPECT_TRUE(watch.has_changed());
  watch.remember();
  EXPECT_FALSE(watch.has_changed());
  watch.add(with_box(100), 1);
  EXPECT_TRUE(watch.has_changed());
  watch.add(table(), 2);
  EXPECT_FALSE(watch.has_changed());
}

TEST(SceneWatch, BeginsAnewWhenTimeOrSizeJumps) {
  SceneWatch watch;
  watch.add(table(), 5);
  watch.add(table(), 3);
  EXPECT_FALSE(watch.at_rest());
  watch.add(table(), 4);
  EXPECT_TRUE(watch.at_rest());
  watch.add(cv::Mat(480, 480, CV_8UC1, cv::Scalar(100)), 5);
  EXPECT_FALSE(watch.at_rest());
}

TEST(SceneWatch, WatchesThePictureOfOnePixel) {
  SceneWatch watch;
  watch.add(cv::Mat(1, 1, CV_8UC1, cv::Scalar(0)), 0);
  watch.add(cv::Mat(1, 1, CV_8UC1, cv::Scalar(0)), 1);
  EXPECT_TRUE(watch.at_rest());
}

TEST(SceneWatch, ThrowsOnOptionsOutOfRange) {
  WatchOptions options;
  options.rest_s = -1;
  EXPECT_THROW(SceneWatch{options}, Error);
}

}  // namespace
}  // namespace posevote::logic
