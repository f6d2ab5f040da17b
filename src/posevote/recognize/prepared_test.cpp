#include "posevote/recognize/prepared.hpp"

#include <gtest/gtest.h>

namespace posevote {
namespace {

std::shared_ptr<const View> make_view(const std::string& hash, int features = 3) {
  auto view = std::make_shared<View>();
  view->hash = hash;
  view->outline = {{0, 0}, {10, 0}, {10, 10}};
  cv::RNG random(hash.size() + static_cast<std::uint64_t>(hash.empty() ? 0 : hash[0]));
  view->features.descriptors.create(features, 64, CV_32F);
  random.fill(view->features.descriptors, cv::RNG::NORMAL, 0, 1);
  for (int i = 0; i < features; ++i) {
    cv::normalize(view->features.descriptors.row(i), view->features.descriptors.row(i));
    view->features.keypoints.push_back({10.F * static_cast<float>(i), 10, 2, 0, 1, 1});
  }
  return view;
}

const auto kTea = make_view("tea"), kBook = make_view("book"), kMug = make_view("mug");

std::shared_ptr<const ModelSet> models_of(std::vector<ObjectModel> objects) {
  return std::make_shared<const ModelSet>("test", std::move(objects));
}

std::string saved() {
  const auto models = models_of({{"tea", {kTea}}, {"book", {kBook}}, {"mug", {kMug}}});
  return save_prepared(*make_index(models), {models, {0, 0, 1, 0, 0, 0, 1, 0, 0}});
}

TEST(Prepared, KnowsObjectsAgainByTheirViewsWhateverTheirNamesAndPlaces) {
  const auto models =
      models_of({{"a new one", {make_view("new")}}, {"cup", {kMug}}, {"tea", {kTea}}});
  const Prepared found = read_prepared(saved(), *models);
  ASSERT_TRUE(found.look_alikes.models);
  ASSERT_EQ(found.look_alikes.models->objects().size(), 2U);
  EXPECT_EQ(found.look_alikes.models->objects()[1].name, "cup");
  EXPECT_EQ(found.look_alikes.table, (std::vector<char>{0, 1, 1, 0}));
  EXPECT_EQ(load_index(models, found.index)->statistics().assigned, 3U) << "those of the new one";
}

TEST(Prepared, AnObjectThatHasAnotherViewIsNotKnown) {
  const auto models = models_of({{"tea", {kTea, make_view("more")}}, {"book", {kBook}}});
  EXPECT_EQ(read_prepared(saved(), *models).look_alikes.models->objects().size(), 1U);
}

TEST(Prepared, ObjectsWithoutHashesAreNotKnown) {
  const auto models = models_of({{"tea", {make_view("")}}, {"book", {make_view("")}}});
  const std::string bytes = save_prepared(*make_index(models), {models, {0, 1, 1, 0}});
  EXPECT_TRUE(read_prepared(bytes, *models).look_alikes.models->objects().empty());
}

TEST(Prepared, DamagedBytesAreAsGoodAsNone) {
  const auto models = models_of({{"tea", {kTea}}});
  const std::string whole = saved();
  for (const std::string& bytes : {std::string(), whole.substr(0, whole.size() / 2), whole + "x"}) {
    EXPECT_TRUE(read_prepared(bytes, *models).index.empty());
    EXPECT_FALSE(read_prepared(bytes, *models).look_alikes.models);
  }
  std::string changed = whole;
  changed[20] = static_cast<char>(changed[20] + 1);
  EXPECT_TRUE(read_prepared(changed, *models).index.empty());
}

}  // namespace
}  // namespace posevote
