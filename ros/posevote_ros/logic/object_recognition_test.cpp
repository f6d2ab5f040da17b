#include "logic/object_recognition.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <thread>

#include "posevote/core/error.hpp"
#include "posevote/image/read_image.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"

namespace posevote::logic {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

#if defined(POSEVOTE_WITH_SURF) && !POSEVOTE_WITH_SURF
constexpr const char* kind = "sift";
constexpr const char* other_kind = "surf";
#else
constexpr const char* kind = "surf";
constexpr const char* other_kind = "sift";
#endif

cv::Mat demo(const std::string& path) {
  return read_image(std::string(POSEVOTE_SOURCE_DIR) + "/data/demo/" + path);
}

ViewSource whole(const cv::Mat& picture) {
  ViewSource source;
  source.picture = picture;
  return source;
}

class ObjectRecognitionTest : public testing::Test {
 protected:
  ObjectRecognitionTest() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(POSEVOTE_BINARY_DIR) / "ros-logic-test" / test->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    settings_["database"] = (folder_ / "objects.db").string();
    if (std::string(kind) == "sift") settings_["feature.kind"] = kind;
  }
  ~ObjectRecognitionTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static std::vector<std::string> names(const DatabaseState& state) {
    std::vector<std::string> found;
    for (const ObjectSummary& object : state.objects) found.push_back(object.name);
    return found;
  }

  fs::path folder_;
  Settings settings_;
  const cv::Mat poster_ = demo("train/poster/cover.jpg");
  const cv::Mat scene_ = demo("test/reading.jpg");
};

TEST_F(ObjectRecognitionTest, TeachesAndRecognisesTheNextPicture) {
  ObjectRecognition node(settings_);
  EXPECT_THAT(node.recognize(scene_, {}).objects, IsEmpty());
  const TaughtPicture taught = node.teach("poster", whole(poster_), "test");
  EXPECT_TRUE(taught.added);
  EXPECT_GT(taught.features, 50);
  const Findings first = node.recognize(scene_, {});
  ASSERT_EQ(first.objects.size(), 1u);
  EXPECT_EQ(first.objects[0].detection.object, "poster");
  EXPECT_FALSE(first.objects[0].track.confirmed);
  EXPECT_EQ(first.objects[0].frame, "posevote/poster_1");
  const Findings second = node.recognize(scene_, {});
  EXPECT_TRUE(second.objects[0].track.confirmed);
  EXPECT_EQ(second.objects[0].track.id, first.objects[0].track.id);
  EXPECT_EQ(node.recognize_once(scene_, {}).objects[0].track.id, 0u);
}

TEST_F(ObjectRecognitionTest, FollowsWhatAnotherProgramTeaches) {
  ObjectRecognition node(settings_);
  EXPECT_TRUE(node.changed());
  EXPECT_FALSE(node.changed());
  {
    ObjectRecognition other(settings_);
    (void)other.teach("poster", whole(poster_), "test");
  }
  while (!node.changed()) std::this_thread::yield();
  EXPECT_EQ(node.recognize(scene_, {}).objects.size(), 1u);
  EXPECT_THAT(names(node.database()), ElementsAre("poster"));
}

TEST_F(ObjectRecognitionTest, TakesOverTheFeaturesThatAnotherProgramUsed) {
  if (std::string(kind) == "sift") GTEST_SKIP() << "this build has one kind only";
  ObjectRecognition node(settings_);
  {
    Settings sift = settings_;
    sift["feature.kind"] = "sift";
    ObjectRecognition other(sift);
    (void)other.teach("poster", whole(poster_), "test");
  }
  while (node.database().features.empty()) std::this_thread::yield();
  EXPECT_EQ(node.recognize(scene_, {}).objects.size(), 1u);
  EXPECT_EQ(node.options().recognize.feature.kind, "sift");
  EXPECT_EQ(node.database().features, "sift");
}

TEST_F(ObjectRecognitionTest, GivesPosesToObjectsOfKnownHeight) {
  settings_["object_heights"] = "poster=0.6";
  ObjectRecognition node(settings_);
  (void)node.teach("poster", whole(poster_), "test");
  Camera camera;
  camera.size = scene_.size();
  camera.matrix = {1100, 0, 639.5, 0, 1100, 479.5, 0, 0, 1};
  const Findings found = node.recognize(scene_, camera);
  ASSERT_TRUE(found.objects.at(0).pose);
  const Pose pose = found.objects[0].pose->pose;
  // 385 px of 0.6 m at this focal length are 1.7 m away.
  EXPECT_NEAR(pose.translation[2], 1.7, 0.15);
  EXPECT_GT(pose.rotation(1, 1), 0.9);  // upright
  EXPECT_LT(found.objects[0].pose->error_px, 3);
  node.set({{"object_heights", ""}});
  const Findings unknown = node.recognize(scene_, camera);
  EXPECT_FALSE(unknown.objects.at(0).pose);
  ASSERT_FALSE(unknown.objects[0].outline.empty());
  EXPECT_NEAR(unknown.objects[0].outline[0][2], 1, 1e-9);
  EXPECT_THAT(node.recognize(scene_, {}).objects.at(0).outline, IsEmpty());
}

TEST_F(ObjectRecognitionTest, SaysWhyThereIsNoPose) {
  ObjectRecognition node(settings_);
  (void)node.teach("poster", whole(poster_), "test");
  Camera camera;
  camera.size = scene_.size();
  camera.matrix = {1100, 0, 639.5, 0, 1100, 479.5, 0, 0, 1};
  camera.distortion_model = "made up";
  camera.distortion = {1};
  EXPECT_THAT(node.recognize(scene_, camera).problem, HasSubstr("made up"));
  node.set({{"rectified", "true"}});
  EXPECT_EQ(node.recognize(scene_, camera).problem, "");
}

TEST_F(ObjectRecognitionTest, LooksForActiveObjectsOnly) {
  ObjectRecognition node(settings_);
  (void)node.teach("poster", whole(poster_), "test");
  ViewSource cherry = whole(demo("train/tea-cherry/y000.jpg"));
  cherry.background = demo("train/tea-cherry/background.jpg");
  (void)node.teach("tea", cherry, "test");
  node.set_active({"tea"});
  for (const FoundObject& object : node.recognize(scene_, {}).objects)
    EXPECT_EQ(object.detection.object, "tea");
  EXPECT_THROW(node.set_active({"tea", "nothing"}), Error);
  EXPECT_THAT(node.database().active, ElementsAre("tea"));
  EXPECT_TRUE(node.database().is_active("tea"));
  EXPECT_FALSE(node.database().is_active("poster"));
  node.rename("tea", "cherry tea");
  EXPECT_THAT(node.database().active, ElementsAre("cherry tea"));
  node.set_active({});
  EXPECT_TRUE(node.database().is_active("poster"));
  const auto all = node.recognize(scene_, {}).objects;
  EXPECT_TRUE(std::any_of(all.begin(), all.end(), [](const FoundObject& object) {
    return object.detection.object == "poster";
  }));
}

TEST_F(ObjectRecognitionTest, RemovesAndRenames) {
  ObjectRecognition node(settings_);
  (void)node.teach("a", whole(poster_), "test");
  node.rename("a", "b");
  EXPECT_THAT(names(node.database()), ElementsAre("b"));
  EXPECT_EQ(node.database().place_of("b"), 0);
  EXPECT_EQ(node.database().place_of("a"), -1);
  EXPECT_EQ(node.recognize(scene_, {}).objects.at(0).detection.object, "b");
  EXPECT_THROW(node.rename("a", "c"), Error);
  EXPECT_THROW(node.remove("b", "no such view"), Error);
  node.remove("b", "");
  EXPECT_THAT(node.recognize(scene_, {}).objects, IsEmpty());
  EXPECT_THROW(node.remove("b", ""), Error);
}

TEST_F(ObjectRecognitionTest, SavesExportsAndImports) {
  ObjectRecognition node(settings_);
  (void)node.teach("poster", whole(poster_), "test");
  const std::string saved = node.save("");
  EXPECT_THAT(saved, HasSubstr(path("objects-")));
  EXPECT_EQ(open_sqlite_store(saved)->list().size(), 1u);
  EXPECT_THROW((void)node.save(saved), Error);
  EXPECT_EQ(node.export_to(path("out.posevote"), {"poster"}, false).views_added, 1);
  EXPECT_THROW((void)node.export_to(path("out.posevote"), {}, false), Error);
  EXPECT_THROW((void)node.import_from(path("out.posevote"), {}, ""), Error);
  EXPECT_THROW((void)node.import_from(path("out.posevote"), {}, "perhaps"), Error);
  EXPECT_EQ(node.import_from(path("out.posevote"), {}, "merge").views_known, 1);
  node.remove("poster", "");
  EXPECT_EQ(node.import_from(path("out.posevote"), {}, "refuse").views_added, 1);
  EXPECT_EQ(node.recognize(scene_, {}).objects.size(), 1u);
}

TEST_F(ObjectRecognitionTest, ChangesOptionsAllOrNothing) {
  ObjectRecognition node(settings_);
  (void)node.teach("poster", whole(poster_), "test");
  EXPECT_THROW(node.set({{"track.confirm_after", "7"}, {"match.no_such", "1"}}), Error);
  EXPECT_EQ(node.options().track.confirm_after, TrackOptions().confirm_after);
  EXPECT_THROW(node.set({{"database", "/other.db"}}), Error);
  EXPECT_THROW(node.set({{"feature.kind", other_kind}}), Error);  // not in this database
  EXPECT_THROW(node.set({{"object_heights", "mug"}}), Error);
  EXPECT_EQ(node.recognize(scene_, {}).objects.size(), 1u);
  node.set({{"feature.max_features", "1"}, {"track.confirm_after", "1"}});
  EXPECT_THAT(node.recognize(scene_, {}).objects, IsEmpty());
  node.set({{"feature.max_features", "3000"}});
  EXPECT_TRUE(node.recognize(scene_, {}).objects.at(0).track.confirmed);
}

TEST_F(ObjectRecognitionTest, StartsWithAPreset) {
  settings_["preset"] = "paper";
  EXPECT_EQ(ObjectRecognition(settings_).options().recognize.rule, "paper");
  settings_["rule"] = "a-contrario";
  EXPECT_EQ(ObjectRecognition(settings_).options().recognize.rule, "a-contrario");
  settings_["preset"] = "best";
  EXPECT_THROW(ObjectRecognition{settings_}, Error);
}

TEST_F(ObjectRecognitionTest, KeepsHowAViewWasTaught) {
  ObjectRecognition node(settings_);
  ViewSource source = whole(demo("train/mug/y030.jpg"));
  source.background = demo("train/mug/background.jpg");
  source.yaw_deg = 30;
  (void)node.teach("mug", source, "/camera/image_raw");
  EXPECT_FALSE(node.teach("mug", source, "/camera/image_raw").added);
  const auto store = open_sqlite_store(settings_["database"]);
  const auto views = store->views("mug");
  ASSERT_EQ(views.size(), 1u);
  EXPECT_EQ(views[0].method, "background");
  EXPECT_EQ(views[0].yaw_deg, 30);
  EXPECT_EQ(views[0].provenance.source, "/camera/image_raw");
}

TEST_F(ObjectRecognitionTest, RecognisesWhileObjectsChange) {
  ObjectRecognition node(settings_);
  (void)node.teach("poster", whole(poster_), "test");
  std::thread services([&] {
    for (int i = 0; i < 5; ++i) {
      node.rename("poster", "other");
      node.set_active({"other"});
      node.rename("other", "poster");
      node.set_active({});
    }
  });
  const cv::Mat small = scene_(cv::Rect(200, 100, 400, 500));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(node.recognize(small, {}).objects.size(), 1u);
  services.join();
}

}  // namespace
}  // namespace posevote::logic
