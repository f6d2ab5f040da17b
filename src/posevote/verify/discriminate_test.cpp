#include "posevote/verify/discriminate.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

const cv::Matx33d kPose(1.2, 0.2, 200, -0.2, 1.2, 120, 0, 0, 1);

/// Two packs of one brand: only the field in the middle differs.
cv::Mat pack(const cv::Scalar& flavour) {
  cv::Mat picture(160, 160, CV_8UC3);
  cv::RNG(7).fill(picture, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(picture, picture, {}, 5);
  cv::normalize(picture, picture, 0, 255, cv::NORM_MINMAX);
  cv::rectangle(picture, {50, 60, 60, 40}, flavour, cv::FILLED);
  return picture;
}

Patch patch_of(const cv::Mat& picture) {
  return make_patch(picture, cv::Mat(picture.size(), CV_8U, cv::Scalar(255)));
}

cv::Mat scene_with(const cv::Mat& picture) {
  cv::Mat scene(480, 640, CV_8UC3, cv::Scalar::all(110));
  cv::warpPerspective(picture, scene, kPose, scene.size(), cv::INTER_LINEAR,
                      cv::BORDER_TRANSPARENT);
  return scene;
}

class Discriminate : public testing::Test {
 protected:
  cv::Mat mint_picture_ = pack({90, 200, 80}), cherry_picture_ = pack({60, 40, 210});
  Patch mint_ = patch_of(mint_picture_), cherry_ = patch_of(cherry_picture_);

  double mint_rather_than_cherry(const cv::Mat& scene) const {
    return discriminate({mint_, kPose}, {cherry_, kPose}, ScenePyramid(scene));
  }
};

TEST_F(Discriminate, TheDifferingFieldDecides) {
  EXPECT_GT(mint_rather_than_cherry(scene_with(mint_picture_)), 0.5);
  EXPECT_LT(mint_rather_than_cherry(scene_with(cherry_picture_)), -0.5);
}

TEST_F(Discriminate, DimAndWarmLightDoesNotMatter) {
  cv::Mat dim;
  cv::multiply(scene_with(mint_picture_), cv::Scalar(0.4, 0.55, 0.7), dim);
  EXPECT_GT(mint_rather_than_cherry(dim), 0.3);
}

TEST_F(Discriminate, ExchangedPlacesExchangeTheSign) {
  const ScenePyramid scene(scene_with(mint_picture_));
  EXPECT_NEAR(discriminate({cherry_, kPose}, {mint_, kPose}, scene),
              -discriminate({mint_, kPose}, {cherry_, kPose}, scene), 0.1);
}

TEST_F(Discriminate, NothingTellsOneThingWithTwoNamesApart) {
  const ScenePyramid scene(scene_with(mint_picture_));
  EXPECT_EQ(discriminate({mint_, kPose}, {mint_, kPose}, scene), 0);
}

TEST_F(Discriminate, WithoutAPictureOrACommonPlaceNothingIsSaid) {
  const ScenePyramid scene(scene_with(mint_picture_));
  const cv::Matx33d elsewhere(1, 0, 20, 0, 1, 300, 0, 0, 1), outside(1, 0, 5000, 0, 1, 0, 0, 0, 1);
  EXPECT_EQ(discriminate({mint_, kPose}, {Patch(), kPose}, scene), 0);
  EXPECT_EQ(discriminate({mint_, kPose}, {cherry_, elsewhere}, scene), 0);
  EXPECT_EQ(discriminate({mint_, outside}, {cherry_, outside}, scene), 0);
}

}  // namespace
}  // namespace posevote
