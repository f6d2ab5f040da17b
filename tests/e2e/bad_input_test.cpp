// Whatever is wrong with the input: the right exit status, one sentence, and an unharmed database.
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "posevote/json/recognition_json.hpp"
#include "program.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;

class BadInput : public Program {
 protected:
  void SetUp() override {
    teach_poster();
    before_ = content(database());
  }
  void TearDown() override {
    EXPECT_EQ(content(database()), before_) << "the database was changed";
    EXPECT_EQ(run({"objects", "list", "--names"}).out, "poster\n");
  }

  std::string huge_png() const {
    std::vector<std::uint8_t> data;
    cv::imencode(".png", cv::Mat(4, 4, CV_8UC3, cv::Scalar::all(9)), data);
    const std::vector<std::uint8_t> size{0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60};  // 60000 x 60000
    std::copy(size.begin(), size.end(), data.begin() + 16);
    return write("huge.png", std::string(data.begin(), data.end()));
  }

  std::string before_;
  std::string scene_ = small_scene();
  std::string view_ = demo("train/muesli/y000.jpg");
};

TEST_F(BadInput, UnreadablePictures) {
  const std::string jpeg = content(scene_);
  std::string damaged_png;
  {
    std::vector<std::uint8_t> data;
    cv::imencode(".png", cv::imread(demo("train/poster/cover.jpg")), data);
    data[data.size() / 2] ^= 0x55;
    damaged_png.assign(data.begin(), data.end());
  }
  const std::vector<std::pair<std::string, std::string>> cases{
      {path("missing.jpg"), "no such file"},
      {write("empty.jpg", std::string()), "empty"},
      {write("text.jpg", std::string("hello")), "not a JPEG"},
      {write("cut.jpg", jpeg.substr(0, jpeg.size() / 2)), "truncated"},
      {write("damaged.png", damaged_png), "damaged"},
      {huge_png(), "megapixels"},
      {"/dev/zero", "regular file"},
      {write("float.tiff", cv::Mat(8, 8, CV_32F, cv::Scalar(0.5))), "8 nor 16"}};
  for (const auto& [file, reason] : cases) {
    expect_failure(run({"teach", "x", file}), 1, {file, reason});
    expect_failure(run({"recognize", file}), 1, {file, reason});
    expect_failure(run({"teach", "x", view_, "--background", file}), 1, {file, reason});
    expect_failure(run({"teach", "x", view_, "--mask", file}), 1, {file, reason});
  }
  expect_failure(run({"teach", "x", folder_}), 1, {folder_, "folder"});
  expect_failure(run({"recognize", write("clip.mp4", std::string("no video"))}), 1, {"clip.mp4"});
  expect_failure(run({"recognize", path("none.mp4")}), 1, {"none.mp4", "no such file"});
  expect_failure(run({"recognize", "camera:971"}), 1, {"camera 971"});
}

TEST_F(BadInput, APictureWithoutPermission) {
  const std::string file = write("secret.jpg", content(scene_));
  chmod(file.c_str(), 0);
  const Outcome outcome = run({"recognize", file}, [] {
    if (geteuid() == 0 && setuid(65534) != 0) _exit(9);  // root may read everything
  });
  expect_failure(outcome, 1, {file, "ermission"});
}

TEST_F(BadInput, AFolderWithoutPictures) {
  fs::create_directory(path("nothing"));
  expect_failure(run({"recognize", path("nothing")}), 1, {path("nothing"), "no pictures"});
}

TEST_F(BadInput, TheOthersAreDoneAllTheSame) {
  const Outcome outcome = run({"recognize", path("missing.jpg"), scene_, "--json"});
  expect_failure(outcome, 1, {"missing.jpg"});
  ASSERT_EQ(outcome.lines().size(), 2U);
  const Json first = Json::parse(outcome.lines()[0]);
  EXPECT_EQ(first["image"], path("missing.jpg"));
  EXPECT_TRUE(first.contains("error"));
  EXPECT_EQ(Json::parse(outcome.lines()[1])["image"], scene_);
}

TEST_F(BadInput, PicturesThatNothingCanBeTaughtFrom) {
  const cv::Mat plain(100, 100, CV_8UC3, cv::Scalar::all(128));
  expect_failure(run({"teach", "x", write("plain.png", plain)}), 1, {"plain.png", "features"});
  expect_failure(run({"teach", "x", write("dot.png", cv::Mat(plain, cv::Rect(0, 0, 1, 1)))}), 1,
                 {"dot.png"});
  expect_failure(run({"teach", "x", view_, "--background", view_}), 1, {view_});
  expect_failure(run({"teach", "x", view_, "--background", write("small.png", plain)}), 1, {view_});
  expect_failure(run({"teach", "x", view_, "--mask", write("small.png", plain)}), 1, {"mask"});
  const cv::Mat black = cv::Mat::zeros(cv::imread(view_).size(), CV_8U);
  expect_failure(run({"teach", "x", view_, "--mask", write("black.png", black)}), 1, {"mask"});
  expect_failure(run({"teach", "x", view_, "--roi", "90000,0,10,10"}), 1, {view_});
}

TEST_F(BadInput, WrongCommandLines) {
  const std::vector<std::vector<std::string>> wrong{
      {},
      {"recognise", scene_},
      {"--nonsense"},
      {"teach"},
      {"teach", "x"},
      {"teach", "x", view_, "--nonsense"},
      {"teach", "x", view_, "--roi", "1,2,3"},
      {"teach", "x", view_, "--roi", "1,2,0,5"},
      {"teach", "x", view_, "--yaw", "east"},
      {"teach", "x", view_, "--yaw", "1", "2"},
      {"teach", "x", view_, "--mask", "a.png", "b.png"},
      {"teach", "x", view_, "--whole", "--roi", "1,2,3,4"},
      {"teach", "x", view_, "--features", "orb"},
      {"teach", "x", view_, "--set", "min_features"},
      {"teach", "x", view_, "--set", "min_features=0"},
      {"recognize"},
      {"recognize", scene_, "--preset", "nonsense"},
      {"recognize", scene_, "--set", "match.max_ratio=-1"},
      {"recognize", scene_, "--set", "match.max_ratio=much"},
      {"recognize", scene_, "--set", "nonsense=1"},
      {"recognize", scene_, "--every", "0"},
      {"objects"},
      {"objects", "lst"},
      {"objects", "remove"},
      {"objects", "rename", "poster"},
      {"objects", "remove", "poster", "other", "--view", "1"},
      {"objects", "import", "x", "--merge", "--replace"},
      {"completion", "cmd.exe"}};
  for (const auto& arguments : wrong) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    expect_failure(run(arguments), 2, {"--help"});
  }
  expect_failure(run({"recognise", scene_}), 2, {"did you mean 'recognize'"});
  expect_failure(run({"recognize", scene_, "--anotate", "x"}), 2, {"did you mean '--annotate'"});
  expect_failure(run({"recognize", scene_, "--set", "match.max_ration=1"}), 2,
                 {"did you mean 'match.max_ratio'"});
}

TEST_F(BadInput, ObjectsThatAreNotThereAndNamesThatMayNotBe) {
  expect_failure(run({"objects", "show", "mug"}), 1, {"mug", database()});
  expect_failure(run({"objects", "remove", "poster", "mug"}), 1, {"mug", database()});
  expect_failure(run({"objects", "remove", "poster", "--view", "7"}), 1, {"7"});
  expect_failure(run({"objects", "rename", "mug", "cup"}), 1, {"mug"});
  expect_failure(run({"objects", "export", path("x.posevote"), "mug"}), 1, {"mug"});
  for (const std::string& name :
       {std::string("a\nb"), std::string("\xff"), std::string(300, 'x')}) {
    expect_failure(run({"teach", name, view_}), 1, {"name"});
    expect_failure(run({"objects", "rename", "poster", name}), 1, {"name"});
  }
  EXPECT_FALSE(fs::exists(path("x.posevote")));
}

TEST_F(BadInput, ExportsAndAnnotationsThatCannotBeWritten) {
  const std::string precious = write("precious", std::string("text"));
  expect_failure(run({"objects", "export", precious}), 1, {precious, "exists"});
  expect_failure(run({"objects", "export", path("no/x.posevote")}), 1, {path("no")});
  expect_failure(run({"recognize", scene_, "--annotate", precious}), 1, {precious});
  expect_failure(run({"objects", "import", precious}), 1, {precious, "not a database"});
  expect_failure(run({"objects", "import", path("none")}), 1, {path("none")});
  EXPECT_EQ(content(precious), "text");
}

TEST_F(BadInput, StandardOutputThatCannotBeWritten) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the sanitizer itself writes a file before the program begins";
#endif
  const Outcome outcome = run({"options"}, [] {
    // The file system as good as full: no file may grow.
    const rlimit none{0, 0};
    setrlimit(RLIMIT_FSIZE, &none);
  });
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.signal, 0);
}

}  // namespace
}  // namespace posevote
