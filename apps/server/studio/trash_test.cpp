#include "studio/trash.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>

#include "http/problem.hpp"
#include "posevote/core/error.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"

namespace posevote::server {
namespace {

namespace fs = std::filesystem;

class TrashTest : public testing::Test {
 protected:
  TrashTest() {
    fs::create_directories(folder_ + "/undo");
    store_ = open_sqlite_store(folder_ + "/objects.db");
    for (const char* name : {"a", "b"})
      for (int i = 0; i < 2; ++i) add(name, name[0] + 50 * i);
  }
  ~TrashTest() override {
    store_.reset();
    fs::remove_all(folder_);
  }

  void add(const std::string& object, int brightness) {
    TaughtView taught;
    taught.view.image_size = {32, 24};
    taught.view.picture = cv::Mat(24, 32, CV_8UC3, cv::Scalar::all(brightness));
    taught.view.outline = {{0, 0}, {10, 0}, {0, 10}};
    taught.view.features.keypoints = {{1, 2, 3, 0, 1, 1}};
    taught.view.features.descriptors = cv::Mat::ones(1, 64, CV_32F) / 8;
    store_->add_view(object, taught, record_features(FeatureOptions()));
  }

  std::size_t views(const std::string& object) const {
    for (const ObjectSummary& one : store_->list())
      if (one.name == object) return static_cast<std::size_t>(one.views);
    return 0;
  }

  std::string folder_ =
      (fs::temp_directory_path() / ("posevote-trash-" + std::to_string(getpid()))).string();
  std::unique_ptr<ObjectStore> store_;
  Trash trash_{folder_ + "/undo", 1000};
};

TEST_F(TrashTest, AnObjectComesBackOnce) {
  const std::string id = trash_.delete_object(*store_, "a");
  EXPECT_EQ(views("a"), 0U);
  EXPECT_EQ(trash_.undo(*store_, id), "a");
  EXPECT_EQ(views("a"), 2U);
  EXPECT_THROW(trash_.undo(*store_, id), Problem);
  EXPECT_TRUE(fs::is_empty(folder_ + "/undo"));
}

TEST_F(TrashTest, AViewComesBackEvenWhenItWasTheLast) {
  const std::string first = trash_.delete_view(*store_, "a", "1");
  const std::string second = trash_.delete_view(*store_, "a", "2");
  EXPECT_EQ(views("a"), 0U);
  trash_.undo(*store_, second);
  trash_.undo(*store_, first);
  EXPECT_EQ(views("a"), 2U);
}

TEST_F(TrashTest, AMergeIsTakenApartAgain) {
  add("b", 'a');  // one view of a is in b, too
  const std::string id = trash_.merge(*store_, "a", "b");
  EXPECT_EQ(views("a"), 0U);
  EXPECT_EQ(views("b"), 4U);
  trash_.undo(*store_, id);
  EXPECT_EQ(views("a"), 2U);
  EXPECT_EQ(views("b"), 3U) << "what b had before the merge";
}

TEST_F(TrashTest, WhatCanComeBackIsListedNewestFirst) {
  EXPECT_TRUE(trash_.list().empty());
  const std::string view = trash_.delete_view(*store_, "a", "1");
  fs::last_write_time(folder_ + "/undo/" + view + ".json",
                      fs::file_time_type::clock::now() - std::chrono::seconds(100));
  const std::string merged = trash_.merge(*store_, "a", "b");
  const auto all = trash_.list();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].id, merged);
  EXPECT_EQ(all[0].into, "b");
  EXPECT_EQ(all[1].id, view);
  EXPECT_EQ(all[1].object, "a");
  EXPECT_EQ(all[1].view, "1");
  EXPECT_GE(all[1].age_s, 100);
  trash_.undo(*store_, merged);
  EXPECT_EQ(trash_.list().size(), 1U);
}

TEST_F(TrashTest, WhatCannotBe) {
  EXPECT_THROW(static_cast<void>(trash_.delete_object(*store_, "x")), Problem);
  EXPECT_THROW(static_cast<void>(trash_.delete_view(*store_, "a", "9")), Error);
  EXPECT_THROW(static_cast<void>(trash_.merge(*store_, "a", "a")), Problem);
  EXPECT_THROW(static_cast<void>(trash_.merge(*store_, "a", "x")), Problem);
  for (const char* id : {"", "x", "../objects", "0123456789abcdef0123456789abcdef"})
    EXPECT_THROW(trash_.undo(*store_, id), Problem) << id;
  const std::string id = trash_.delete_object(*store_, "a");
  store_->rename_object("b", "a");
  EXPECT_THROW(trash_.undo(*store_, id), Error) << "the name is another object's now";
  EXPECT_EQ(views("a"), 2U);
}

TEST_F(TrashTest, OldDeletionsAreForgotten) {
  const std::string id = trash_.delete_object(*store_, "a");
  trash_.expire();
  EXPECT_FALSE(fs::is_empty(folder_ + "/undo"));
  const Trash impatient(folder_ + "/undo", -1);
  EXPECT_TRUE(fs::is_empty(folder_ + "/undo"));
  EXPECT_THROW(trash_.undo(*store_, id), Problem);
}

}  // namespace
}  // namespace posevote::server
