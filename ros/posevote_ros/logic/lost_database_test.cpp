// A node whose shared database cannot be reached for a while.
#include <gmock/gmock.h>

#include "logic/object_recognition.hpp"
#include "posevote/image/read_image.hpp"
#include "posevote/store/postgres/postgres_store.hpp"
#include "posevote/store/postgres/relay.hpp"
#include "posevote/store/postgres/test_server.hpp"

namespace posevote::logic {
namespace {

cv::Mat demo(const std::string& path) {
  return read_image(std::string(POSEVOTE_SOURCE_DIR) + "/data/demo/" + path);
}

class LostDatabase : public postgres::ServerTest {
 protected:
  void SetUp() override {
    ServerTest::SetUp();
    if (IsSkipped()) return;
    relay_ = std::make_unique<postgres::Relay>(server_.socket_path());
    node_ = std::make_unique<ObjectRecognition>(Settings{{"database", relay_->address(database_)}});
    ViewSource poster;
    poster.picture = demo("train/poster/cover.jpg");
    (void)node_->teach("poster", poster, "test");
  }
  void TearDown() override {
    node_.reset();
    relay_.reset();
    ServerTest::TearDown();
  }

  /// Feeds frames until `done`, and a few more; in each there must be as many objects as
  /// `expected`.
  void feed(
      std::size_t expected, const std::function<bool()>& done = [] { return true; }) {
    for (int more = 3; more > 0; more -= done())
      ASSERT_EQ(node_->recognize(scene_, {}).objects.size(), expected);
  }

  std::unique_ptr<postgres::Relay> relay_;
  std::unique_ptr<ObjectRecognition> node_;
  const cv::Mat scene_ = demo("test/reading.jpg")(cv::Rect(200, 100, 400, 500));
};

TEST_F(LostDatabase, RecognitionGoesOnAndCatchesUp) {
  feed(1);
  relay_->set_down(true);
  feed(1, [&] { return !node_->database().problem.empty(); });
  EXPECT_EQ(node_->database().objects.size(), 1U);
  open_postgres_store(server_.address(database_))->rename_object("poster", "big poster");
  feed(1);
  EXPECT_THROW(node_->remove("poster", ""), Error);
  node_->set({{"track.confirm_after", "1"}});
  feed(1);
  relay_->set_down(false);
  feed(1, [&] { return node_->database().place_of("big poster") == 0; });
  EXPECT_EQ(node_->recognize(scene_, {}).objects.at(0).detection.object, "big poster");
  while (!node_->database().problem.empty()) std::this_thread::yield();
  node_->remove("big poster", "");
  feed(0);
}

TEST_F(LostDatabase, NoFrameWaitsForAServerThatIsSilent) {
  relay_->set_frozen(true);
  open_postgres_store(server_.address(database_))->remove_object("poster");
  feed(1);
  relay_->set_frozen(false);
  while (!node_->database().objects.empty()) std::this_thread::yield();
  feed(0);
}

}  // namespace
}  // namespace posevote::logic
