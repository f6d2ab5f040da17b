#include "posevote/teach/repeatable.hpp"

#include <gtest/gtest.h>

#include "posevote/teach/made_pictures.hpp"
#include "posevote/teach/teacher.hpp"

namespace posevote {
namespace {

std::shared_ptr<const Extractor> sift() {
  FeatureOptions options;
  options.kind = "sift";
  return make_extractor(options);
}

// Print on the left half, noise on the right.
cv::Mat print_and_noise() {
  cv::Mat picture(300, 480, CV_8UC3, cv::Scalar(120, 120, 120));
  made::box_art({240, 300}).copyTo(picture(cv::Rect(0, 0, 240, 300)));
  cv::Mat right = picture(cv::Rect(240, 0, 240, 300));
  made::add_noise(right, 30, 3);
  return picture;
}

TEST(FindRepeatable, KeepsPrintAndDropsNoise) {
  const cv::Mat picture = print_and_noise();
  const Features features = sift()->extract(picture, {});
  const auto repeats = find_repeatable(picture, {}, features, *sift());
  ASSERT_EQ(repeats.size(), features.size());
  int count[2] = {}, kept[2] = {};
  for (std::size_t i = 0; i < features.size(); ++i) {
    const int side = features.keypoints[i].x > 240;
    ++count[side];
    kept[side] += repeats[i];
  }
  ASSERT_GT(count[0], 50);
  ASSERT_GT(count[1], 50);
  EXPECT_GT(kept[0], 0.7 * count[0]);
  EXPECT_LT(kept[1], 0.4 * count[1]);
}

TEST(FindRepeatable, TakesNoFeaturesAndTinyPictures) {
  EXPECT_TRUE(find_repeatable(print_and_noise(), {}, {}, *sift()).empty());
  const cv::Mat tiny(3, 2, CV_8UC3, cv::Scalar(9, 9, 9));
  EXPECT_TRUE(find_repeatable(tiny, {}, sift()->extract(tiny, {}), *sift()).empty());
}

TEST(TeachView, KeepsOnlyWhatRepeatsWhenAsked) {
  TeachOptions options;
  options.feature.kind = "sift";
  ViewSource source;
  source.picture = print_and_noise();
  options.only_repeatable = false;
  const View all = teach_view(source, options);
  options.only_repeatable = true;
  const View fewer = teach_view(source, options);
  EXPECT_LT(fewer.features.size(), all.features.size());
  EXPECT_EQ(fewer.features.descriptors.rows, static_cast<int>(fewer.features.size()));
  // What is left is in the same order as before.
  std::size_t at = 0;
  for (const Keypoint& k : fewer.features.keypoints) {
    const auto is_here = [&](const Keypoint& other) {
      return other.x == k.x && other.y == k.y && other.scale == k.scale && other.angle == k.angle;
    };
    while (at < all.features.size() && !is_here(all.features.keypoints[at])) ++at;
    ASSERT_LT(at, all.features.size());
  }
}

}  // namespace
}  // namespace posevote
