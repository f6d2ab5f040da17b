#include "posevote/model/model_set.hpp"

#include <gtest/gtest.h>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

std::shared_ptr<View> make_view(int features, int dimension = 64) {
  auto view = std::make_shared<View>();
  view->id = "1";
  view->outline = {{0, 0}, {10, 0}, {10, 10}};
  view->features.keypoints.resize(static_cast<std::size_t>(features));
  view->features.descriptors = cv::Mat::zeros(features, dimension, CV_32F);
  return view;
}

TEST(ModelSet, NumbersViewsObjectByObject) {
  const ModelSet set("surf", {{"tea", {make_view(3), make_view(0)}}, {"book", {make_view(2)}}});
  ASSERT_EQ(set.views().size(), 3U);
  EXPECT_EQ(set.name_of_view(1), "tea");
  EXPECT_EQ(set.name_of_view(2), "book");
  EXPECT_EQ(set.feature_count(), 5U);
}

TEST(ModelSet, RefusesTwoObjectsOfOneName) {
  EXPECT_THROW(ModelSet("surf", {{"tea", {}}, {"tea", {}}}), Error);
  EXPECT_THROW(ModelSet("surf", {{"", {}}}), Error);
}

TEST(ModelSet, RefusesDescriptorsThatCannotBeCompared) {
  EXPECT_THROW(ModelSet("surf", {{"tea", {make_view(1, 64), make_view(1, 128)}}}), Error);
  auto short_of_one = make_view(2);
  short_of_one->features.keypoints.pop_back();
  EXPECT_THROW(ModelSet("surf", {{"tea", {short_of_one}}}), Error);
}

TEST(ModelSet, RefusesAViewWithoutOutline) {
  auto view = make_view(1);
  view->outline.clear();
  EXPECT_THROW(ModelSet("surf", {{"tea", {view}}}), Error);
}

TEST(ModelSet, MayBeEmpty) {
  const ModelSet set("surf", {});
  EXPECT_TRUE(set.views().empty());
}

}  // namespace
}  // namespace posevote
