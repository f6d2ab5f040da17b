#include "posevote/match/matcher.hpp"

#include <gtest/gtest.h>

namespace posevote {
namespace {

/// A view whose key points lie 50 px apart in a row.
std::shared_ptr<View> make_view(int features) {
  auto view = std::make_shared<View>();
  view->outline = {{0, 0}, {100, 0}, {100, 100}};
  for (int i = 0; i < features; ++i)
    view->features.keypoints.push_back({50.F * static_cast<float>(i), 0, 2, 0, 1, 1});
  view->features.descriptors = cv::Mat::zeros(features, 64, CV_32F);
  return view;
}

const ModelSet kModels("surf", {{"tea", {make_view(3), make_view(3)}}, {"book", {make_view(3)}}});

TEST(Neighborhood, ReferenceIsTheNearestOfAnotherObject) {
  // Views 0 and 1 are tea, view 2 is the book.
  const Neighborhood neighborhood({{{0, 0, 0.1F}, {1, 0, 0.15F}, {2, 1, 0.4F}}}, kModels);
  EXPECT_FLOAT_EQ(neighborhood.reference(0, 0, 0).distance, 0.4F);
  EXPECT_FLOAT_EQ(neighborhood.reference(0, 2, 1).distance, 0.1F);
}

TEST(Neighborhood, AnotherSpotOfTheSameViewIsAReference) {
  const Neighborhood neighborhood({{{0, 0, 0.1F}, {0, 1, 0.2F}, {2, 1, 0.4F}}}, kModels);
  EXPECT_FLOAT_EQ(neighborhood.reference(0, 0, 0).distance, 0.2F);
}

TEST(Neighborhood, ThePoolIsAReference) {
  const Neighborhood neighborhood({{{0, 0, 0.1F}, {-1, 7, 0.3F}}}, kModels);
  EXPECT_FLOAT_EQ(neighborhood.reference(0, 0, 0).distance, 0.3F);
}

TEST(Neighborhood, WithOneObjectTheFarthestNeighbourIsTheReference) {
  const ModelSet one("surf", {{"tea", {make_view(3), make_view(3)}}});
  const Neighborhood neighborhood({{{0, 0, 0.1F}, {1, 0, 0.3F}}}, one);
  EXPECT_FLOAT_EQ(neighborhood.reference(0, 0, 0).distance, 0.3F);
  EXPECT_DOUBLE_EQ(neighborhood.reference(0, 0, 0).rate, 2.0 / 6);
}

TEST(Neighborhood, RelatedObjectsAreNoReference) {
  const Neighborhood neighborhood({{{0, 0, 0.1F}, {2, 1, 0.2F}, {-1, 0, 0.5F}}}, kModels,
                                  {1, 1, 1, 1});
  EXPECT_FLOAT_EQ(neighborhood.reference(0, 0, 0).distance, 0.5F);
}

TEST(MatchFeatures, KeepsWhatPassesTheRatioForSeveralViews) {
  const Neighborhood neighborhood(
      {{{0, 0, 0.1F}, {1, 0, 0.15F}, {2, 1, 0.4F}}, {{0, 2, 0.35F}, {2, 2, 0.4F}}, {}}, kModels);
  MatchOptions options;
  options.max_ratio = 0.8;
  const auto matches = match_features(neighborhood, options);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].view, 0);
  EXPECT_EQ(matches[1].view, 1);
  EXPECT_FLOAT_EQ(matches[0].ratio, 0.25F);
}

TEST(MatchFeatures, IgnoresThePoolItself) {
  const Neighborhood neighborhood({{{-1, 0, 0.1F}, {2, 1, 0.4F}}}, kModels);
  EXPECT_TRUE(match_features(neighborhood, {}).empty());
}

}  // namespace
}  // namespace posevote
