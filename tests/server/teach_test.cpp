// Teach an object the way the page does, and find it in the very next frame.
#include <filesystem>
#include <set>

#include "server_process.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;

class TeachOverHttp : public ServerTest {
 protected:
  void put(const std::string& path, const std::string& body = "") {
    const auto result = client().Put(path, body, "image/jpeg");
    ASSERT_TRUE(result && result->status == 200) << path << (result ? result->body : "");
  }

  /// Shows this one picture to the camera until frames of it arrive.
  void show(const std::string& picture) {
    fs::copy_file(picture, camera_ + "/a.part", fs::copy_options::overwrite_existing);
    fs::rename(camera_ + "/a.part", camera_ + "/100.jpg");
    const std::int64_t frame = get("/api/live")["frame"];
    ASSERT_TRUE(eventually([&] { return get("/api/live")["frame"] >= frame + 3; }));
  }

  static std::set<std::string> names_of(const Json& recognition) {
    std::set<std::string> names;
    for (const Json& detection : recognition["detections"]) names.insert(detection["object"]);
    return names;
  }

  std::string camera_;
};

TEST_F(TeachOverHttp, FromTheCameraToTheNextFrame) {
  camera_ = make_camera("camera", {demo("train/muesli/background.jpg")});
  start({"--camera", camera_, "--fps", "20"});
  ASSERT_TRUE(eventually([&] { return get("/api/live")["state"] == "running"; }));
  const std::string session = post("/api/teach-sessions")["session"];
  const std::string one = "/api/teach-sessions/" + session;
  put(one + "/background");
  const Json empty = post(one + "/proposal");
  EXPECT_EQ(empty["usable"], false);
  EXPECT_FALSE(empty["advice"].empty()) << "it says what to do";

  show(demo("train/muesli/y000.jpg"));
  const Json first = post(one + "/proposal?yaw=0");
  EXPECT_EQ(first["usable"], true) << first;
  EXPECT_EQ(first["method"], "background");
  EXPECT_GT(first["outline"].size(), 3U);
  EXPECT_EQ(client().Get(one + "/proposal/mask")->status, 200);
  EXPECT_EQ(post(one + "/views")["views"].size(), 1U);
  EXPECT_EQ(post(one + "/proposal?yaw=1")["adds_little"], true) << "the same side again";

  show(demo("train/muesli/y036.jpg"));
  post(one + "/proposal");
  const Json now = post(one + "/views?yaw=36");
  EXPECT_EQ(now["views"][1]["yaw"], 36);
  EXPECT_EQ(now["enough"], false);
  EXPECT_EQ(names_of(get("/api/live").value("result", Json{{"detections", Json::array()}})).size(),
            0U);

  const Json saved = post(one + "/save", R"({"object": "cereal"})", "application/json");
  EXPECT_EQ(saved["views_added"], 2);
  // A frame that was there before may be in the hands of the recogniser of before.
  const std::int64_t there = get("/api/live")["frame"];
  Json next;
  ASSERT_TRUE(eventually([&] {
    next = get("/api/live").value("result", Json{{"frame", -1}});
    return next["frame"] > there;
  }));
  EXPECT_TRUE(names_of(next).contains("cereal")) << "in the very next frame";
  EXPECT_EQ(get("/api/teach-sessions")["sessions"].size(), 0U);
  EXPECT_EQ(get("/api/objects")["objects"][0]["object"], "cereal");
}

TEST_F(TeachOverHttp, UploadedViewsAreRecognisedAtOnce) {
  start();
  const std::string scene = content(demo("train/poster/cover.jpg"));
  EXPECT_TRUE(names_of(post("/api/recognize", scene)).empty());
  teach_poster();
  EXPECT_EQ(names_of(post("/api/recognize", scene)), std::set<std::string>{"poster"});
  client().Delete("/api/objects/poster");
  EXPECT_TRUE(names_of(post("/api/recognize", scene)).empty());
}

TEST_F(TeachOverHttp, MergeAndUndo) {
  start();
  teach_poster();
  const std::string other = content(demo("train/muesli/y000.jpg"));
  post("/api/objects/box/views", other);
  const auto names = [&] {
    std::map<std::string, int> views;
    const Json objects = get("/api/objects")["objects"];
    for (const Json& object : objects) views[object["object"]] = object["views"];
    return views;
  };
  const Json undo = post("/api/objects/box/merge", R"({"into": "poster"})", "application/json");
  EXPECT_EQ(names(), (std::map<std::string, int>{{"poster", 2}}));
  post("/api/undo/" + undo["undo"].get<std::string>());
  EXPECT_EQ(names(), (std::map<std::string, int>{{"box", 1}, {"poster", 1}}));
}

TEST_F(TeachOverHttp, AWrongDetectionIsNotMadeAgain) {
  const std::string scene = demo("train/poster/cover.jpg");
  const std::string camera = make_camera("camera", {scene});
  start({"--camera", camera, "--fps", "10"});
  teach_poster();
  Json result;
  ASSERT_TRUE(eventually([&] {
    result = get("/api/live").value("result", Json::object());
    return result.contains("detections") && !result["detections"].empty();
  }));
  const Json box = result["detections"][0]["box"];
  std::string text;
  for (const Json& number : box) {
    if (!text.empty()) text += ',';
    text += number.dump();
  }
  const Json impostor = post("/api/impostors?frame=" + result["frame"].dump() + "&box=" + text);
  EXPECT_GT(impostor["features"], 0);
  EXPECT_TRUE(eventually([&] { return get("/api/live")["result"]["detections"].empty(); }));
}

TEST_F(TeachOverHttp, AClientsCameraIsASource) {
  start();
  EXPECT_EQ(get("/api/source")["source"], "client");
  teach_poster();
  const std::string picture = content(demo("train/poster/cover.jpg"));
  Json posted = post("/api/live/frame", picture), live;
  ASSERT_TRUE(eventually([&] {
    live = get("/api/live");
    if (live["frame"] == -1) posted = post("/api/live/frame", picture);  // too old to be shown
    return live.contains("result") && live["result"]["frame"] == posted["frame"];
  }));
  EXPECT_TRUE(names_of(live["result"]).contains("poster"));
  ASSERT_TRUE(eventually([&] { return get("/api/live")["state"] == "waiting"; }))
      << "who is silent is taken for gone";
  live = get("/api/live");
  EXPECT_TRUE(live["frame"] == -1 || names_of(live["result"]).contains("poster"))
      << "but has the answer to the last picture";
}

TEST_F(TeachOverHttp, SettingsAreKeptOverARestartAndGovernRecognition) {
  start();
  teach_poster();
  const std::string scene = content(demo("train/poster/cover.jpg"));
  patch("/api/settings", {{"recognize.verify.false_alarms_per_1000_images", 0.001}});
  EXPECT_TRUE(names_of(post("/api/recognize", scene)).empty());
  start();
  EXPECT_TRUE(names_of(post("/api/recognize", scene)).empty()) << "it is kept";
  patch("/api/settings", {{"recognize.verify.false_alarms_per_1000_images", nullptr}});
  EXPECT_TRUE(names_of(post("/api/recognize", scene)).contains("poster"));
}

}  // namespace
}  // namespace posevote
