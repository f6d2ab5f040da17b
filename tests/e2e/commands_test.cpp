// The commands doing what they are for.
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "posevote/json/recognition_json.hpp"
#include "program.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

class Commands : public Program {
 protected:
  /// The names found in a picture.
  std::vector<std::string> found(const std::string& picture) const {
    return names_in(run({"recognize", picture, "--json"}));
  }

  static std::vector<std::string> names_in(const Outcome& recognized) {
    EXPECT_EQ(recognized.status, 0) << recognized.err;
    EXPECT_EQ(recognized.lines().size(), 1U);
    std::vector<std::string> names;
    const Json line = Json::parse(recognized.lines().at(0));
    for (const Json& detection : line["detections"]) names.push_back(detection["object"]);
    return names;
  }

  cv::Mat poster_ = cv::imread(demo("train/poster/cover.jpg"));
};

TEST_F(Commands, HelpTeachesByExamples) {
  EXPECT_THAT(run({"--version"}).out, StartsWith("posevote "));
  const Outcome help = run({"--help"});
  EXPECT_EQ(help.status, 0);
  for (const char* command : {"teach", "recognize", "objects", "evaluate", "bench", "completion"}) {
    EXPECT_THAT(help.out, HasSubstr(command));
    const Outcome more = run({command, "--help"});
    EXPECT_EQ(more.status, 0);
    EXPECT_THAT(more.out, HasSubstr("Usage: posevote " + std::string(command)));
  }
  EXPECT_THAT(run({"teach", "--help"}).out, HasSubstr("posevote teach mug"));
}

TEST_F(Commands, ATaughtPictureIsRecognised) {
  teach_poster();
  EXPECT_THAT(found(demo("train/poster/cover.jpg")), testing::ElementsAre("poster"));
}

TEST_F(Commands, TwoCopiesOfATeaAreToldFromItsOtherFlavour) {
  for (const std::string name : {"tea-mint", "tea-cherry"}) {
    const std::string folder = demo("train/" + name + "/");
    const Outcome taught = run({"teach", name, folder + "y000.jpg", folder + "y036.jpg",
                                "--background", folder + "background.jpg"});
    ASSERT_EQ(taught.status, 0) << taught.err;
  }
  const Outcome outcome = run({"recognize", demo("test/twice.jpg"), "--json"});
  EXPECT_THAT(outcome.out, testing::Not(HasSubstr("alternatives")));
  EXPECT_THAT(names_in(outcome),
              testing::UnorderedElementsAre("tea-mint", "tea-mint", "tea-cherry"));
}

TEST_F(Commands, EveryWayToSayWhereTheObjectIsWorks) {
  const std::string view = demo("train/muesli/y000.jpg"), next = demo("train/muesli/y036.jpg");
  EXPECT_EQ(run({"teach", "a", view, next, "--background", demo("train/muesli/background.jpg"),
                 "--yaw", "0", "-36"})
                .status,
            0);
  EXPECT_EQ(run({"teach", "b", view, "--mask", demo("masks/muesli/y000.png")}).status, 0);
  EXPECT_EQ(run({"teach", "c", view, "--roi", "200,120,260,280"}).status, 0);
  EXPECT_EQ(run({"teach", "d", view, "--whole"}).status, 0);
  const Outcome list = run({"objects", "list", "--json"});
  ASSERT_EQ(list.lines().size(), 4U);
  EXPECT_EQ(Json::parse(list.lines()[0])["views"], 2);
  const Outcome show = run({"objects", "show", "a", "--json"});
  EXPECT_EQ(Json::parse(show.lines()[1])["yaw"], -36);
  const Json second = Json::parse(show.lines()[1]);
  EXPECT_EQ(second["method"], "background");
  const std::string text = run({"objects", "show", "a"}).out;
  for (const char* key : {"taught_at", "source", "version"})
    EXPECT_THAT(text, HasSubstr(second[key].get<std::string>())) << key;
}

TEST_F(Commands, TeachingAgainAddsNothingTwice) {
  teach_poster();
  const Outcome again = run({"teach", "poster", demo("train/poster/cover.jpg")});
  EXPECT_EQ(again.status, 0);
  EXPECT_THAT(again.out, HasSubstr("already"));
  EXPECT_EQ(run({"objects", "show", "poster", "--json"}).lines().size(), 1U);
}

TEST_F(Commands, TeachingLeavesOutViewsThatAddLittleWhenAsked) {
  teach_poster();
  cv::Mat darker;
  poster_.convertTo(darker, -1, 0.8);
  const std::string again = write("again.png", darker);
  const Outcome both =
      run({"teach", "poster", again, demo("train/muesli/y000.jpg"), "--whole", "--skip-redundant"});
  EXPECT_EQ(both.status, 0);
  EXPECT_THAT(both.out, HasSubstr("again.png is left out"));
  EXPECT_EQ(run({"objects", "show", "poster", "--json"}).lines().size(), 2U);
  EXPECT_EQ(run({"teach", "poster", again, "--whole"}).status, 0);
  EXPECT_EQ(run({"objects", "show", "poster", "--json"}).lines().size(), 3U);
}

TEST_F(Commands, TeachingRatesTheViewsAndNamesWhatLooksAlike) {
  const auto teach = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"teach", name, demo("train/" + name + "/y000.jpg"),
                                          "--background",
                                          demo("train/" + name + "/background.jpg")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments).out;
  };
  EXPECT_THAT(teach("tea-mint", {}), testing::AllOf(HasSubstr("found from"), HasSubstr(" px")));
  EXPECT_THAT(teach("tea-cherry", {}), HasSubstr("tea-cherry looks like tea-mint: "));
  EXPECT_THAT(teach("mug", {"--brief"}), Not(HasSubstr("found from")));
}

TEST_F(Commands, EveryKindOfPixelIsRecognised) {
  teach_poster();
  cv::Mat grey, bgra, deep;
  cv::cvtColor(poster_, grey, cv::COLOR_BGR2GRAY);
  cv::cvtColor(poster_, bgra, cv::COLOR_BGR2BGRA);
  poster_.convertTo(deep, CV_16U, 256);
  const auto poster = testing::ElementsAre("poster");
  EXPECT_THAT(found(write("grey.png", grey)), poster);
  EXPECT_THAT(found(write("bgra.png", bgra)), poster);
  EXPECT_THAT(found(write("deep.png", deep)), poster);
}

TEST_F(Commands, OnePixelAndTwentyMegapixelsAreRecognised) {
  teach_poster();
  EXPECT_THAT(found(write("dot.png", cv::Mat(1, 1, CV_8UC3, cv::Scalar(9, 90, 200)))),
              testing::IsEmpty());
  cv::Mat large(4000, 5000, CV_8UC3, cv::Scalar::all(120));
  poster_.copyTo(large(cv::Rect({4000, 3000}, poster_.size())));
  EXPECT_THAT(found(write("large.jpg", large)), testing::ElementsAre("poster"));
}

TEST_F(Commands, ExifRotatedPicturesAreSeenUpright) {
  teach_poster();
  cv::Mat turned;
  cv::rotate(poster_, turned,
             cv::ROTATE_90_COUNTERCLOCKWISE);  // as a camera held upright stores it
  std::vector<std::uint8_t> data;
  cv::imencode(".jpg", turned, data);
  const std::vector<std::uint8_t> exif{0xff, 0xe1, 0, 34, 'E', 'x', 'i', 'f', 0, 0,  'M', 'M',
                                       0,    42,   0, 0,  0,   8,   0,   1,   1, 18, 0,   3,
                                       0,    0,    0, 1,  0,   6,   0,   0,   0, 0,  0,   0};
  data.insert(data.begin() + 2, exif.begin(), exif.end());
  const std::string file = write("turned.jpg", std::string(data.begin(), data.end()));
  const Outcome outcome = run({"recognize", file, "--json"});
  const Json line = Json::parse(outcome.lines().at(0));
  EXPECT_EQ(line["width"], poster_.cols);
  EXPECT_EQ(line["height"], poster_.rows);
  ASSERT_EQ(line["detections"].size(), 1U);
  const Json homography = line["detections"][0]["homography"];
  EXPECT_NEAR(homography[0][0].get<double>(), 1, 0.05) << "neither turned nor scaled";
  EXPECT_NEAR(homography[1][0].get<double>(), 0, 0.05);
}

TEST_F(Commands, WhatNoObjectExplainsIsReportedOnRequest) {
  teach_poster();
  const std::string scene = demo("test/kitchen.jpg");
  EXPECT_THAT(run({"recognize", scene}).out, Not(HasSubstr("(unknown)")));
  EXPECT_THAT(run({"recognize", scene, "--set", "unknown=true"}).out, HasSubstr("(unknown)"));
  EXPECT_THAT(run({"recognize", scene, "--set", "unknown=true", "--json"}).out,
              HasSubstr(R"("unknown":[{"box":)"));
}

TEST_F(Commands, FoldersGiveALineForEachPicture) {
  teach_poster();
  fs::create_directory(path("scenes"));
  write("scenes/b.png", poster_);
  write("scenes/a.png", cv::Mat(50, 60, CV_8UC3, cv::Scalar::all(90)));
  write("scenes/notes.txt", std::string("not a picture"));
  const auto lines = run({"recognize", path("scenes"), "--json"}).lines();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(Json::parse(lines[0])["image"], path("scenes/a.png"));
  EXPECT_EQ(Json::parse(lines[0])["detections"].size(), 0U);
  EXPECT_EQ(Json::parse(lines[1])["detections"].size(), 1U);
}

TEST_F(Commands, VideosGiveALineForEachFrame) {
  teach_poster();
  cv::Mat frame;
  cv::resize(poster_, frame, {320, 320 * poster_.rows / poster_.cols / 2 * 2}, 0, 0,
             cv::INTER_AREA);
  {
    cv::VideoWriter writer(path("clip.avi"), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10,
                           frame.size());
    for (int i = 0; i < 4; ++i) writer.write(frame);
  }
  const auto lines = run({"recognize", path("clip.avi"), "--json", "--every", "2"}).lines();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(Json::parse(lines[1])["frame"], 2);
  EXPECT_EQ(Json::parse(lines[1])["detections"][0]["object"], "poster");
  EXPECT_GT(Json::parse(lines[1])["latency_ms"], 0);
}

TEST_F(Commands, LiveVideosNeverMissTheLastFrame) {
  teach_poster();
  {
    cv::VideoWriter writer(path("clip.avi"), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 100,
                           {320, 240});
    for (int i = 0; i < 30; ++i) writer.write(cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(i)));
  }
  const auto lines = run({"recognize", path("clip.avi"), "--live", "--json"}).lines();
  ASSERT_GE(lines.size(), 1U);
  EXPECT_EQ(Json::parse(lines.back())["frame"], 29);
}

TEST_F(Commands, AnnotatedPicturesAreWritten) {
  teach_poster();
  const std::string scene = demo("train/poster/cover.jpg");
  const Outcome outcome = run({"recognize", scene, scene, "--annotate", path("found")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(path("found/cover-recognized.jpg")));
  EXPECT_EQ(cv::imread(path("found/cover-recognized.jpg")).size(), poster_.size());
  EXPECT_TRUE(fs::exists(path("found/cover-2-recognized.jpg")));
  EXPECT_TRUE(outcome.err.empty()) << "no progress bar without a terminal";
}

TEST_F(Commands, ExplainSaysWhatBecameOfAnObjectAndDrawsIt) {
  teach_poster();
  const Outcome seen = run({"explain", demo("train/poster/cover.jpg"), "--object", "poster",
                            "--json", "--draw", path("why.png")});
  EXPECT_EQ(seen.status, 0) << seen.err;
  const Json line = Json::parse(seen.lines().at(0));
  EXPECT_TRUE(line["found"]);
  EXPECT_GT(line["matched"], line["largest_bin"].get<int>() / 2);
  EXPECT_EQ(line["best"]["object"], "poster");
  EXPECT_EQ(cv::imread(path("why.png")).cols, 2 * poster_.cols);
  const Outcome unseen = run({"explain", demo("train/muesli/background.jpg")});
  EXPECT_THAT(unseen.out, HasSubstr("poster: not found"));
  EXPECT_THAT(unseen.out, HasSubstr("(option "));
  const Outcome unknown = run({"explain", demo("train/poster/cover.jpg"), "--object", "postr"});
  EXPECT_EQ(unknown.status, 1);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'poster'?"));
}

TEST_F(Commands, ObjectsCanBeRenamedExportedRemovedAndImported) {
  teach_poster();
  EXPECT_EQ(run({"objects", "rename", "poster", "das große Bild"}).status, 0);
  EXPECT_EQ(run({"objects", "export", path("x.posevote")}).status, 0);
  EXPECT_EQ(run({"objects", "remove", "das große Bild"}).status, 0);
  EXPECT_THAT(run({"objects", "list"}).out, HasSubstr("no objects"));
  EXPECT_EQ(run({"objects", "import", path("x.posevote")}).status, 0);
  EXPECT_EQ(run({"objects", "list", "--names"}).out, "das große Bild\n");
  EXPECT_THAT(found(demo("train/poster/cover.jpg")), testing::ElementsAre("das große Bild"));
}

TEST_F(Commands, KeptPicturesAreThoseThatWereTaught) {
  teach_poster();
  EXPECT_EQ(run({"objects", "show", "poster", "--pictures", path("kept")}).status, 0);
  EXPECT_EQ(content(path("kept/view-1.jpeg")), content(demo("train/poster/cover.jpg")));
}

TEST_F(Commands, OtherFeaturesAreRefusedUntilTheDatabaseIsRebuilt) {
  if (!POSEVOTE_WITH_SURF) GTEST_SKIP() << "this build knows one kind of features only";
  teach_poster();
  const std::string before = content(database());
  expect_failure(run({"teach", "other", demo("train/muesli/y000.jpg"), "--features", "sift"}), 1,
                 {"objects rebuild", database()});
  expect_failure(run({"recognize", small_scene(), "--features", "sift"}), 1, {"objects rebuild"});
  EXPECT_EQ(content(database()), before);
  EXPECT_EQ(run({"objects", "rebuild", "--features", "sift"}).status, 0);
  EXPECT_EQ(run({"teach", "other", demo("train/muesli/y000.jpg"), "--features", "sift"}).status, 0);
  EXPECT_THAT(found(demo("train/poster/cover.jpg")), testing::Contains("poster"))
      << "recognition uses the database's features without being told";
}

TEST_F(Commands, OptionsCanBeListedAndSet) {
  const Outcome list = run({"options"});
  EXPECT_THAT(list.out, HasSubstr("match.max_ratio"));
  EXPECT_THAT(list.out, HasSubstr("teach.min_features"));
  teach_poster();
  EXPECT_EQ(
      run({"recognize", small_scene(), "--set", "match.max_ratio=0.7", "--preset", "paper"}).status,
      0);
}

TEST_F(Commands, BenchTimesEveryStep) {
  teach_poster();
  const Outcome bench = run({"bench", "--repeat", "1"});
  EXPECT_EQ(bench.status, 0) << bench.err;
  for (const char* step : {"detect", "match", "Hough", "verification", "total"})
    EXPECT_THAT(bench.out, HasSubstr(step));
}

TEST_F(Commands, ImpostorsAreKept) {
  EXPECT_EQ(run({"objects", "impostors", "add", demo("test/strangers.jpg")}).status, 0);
  EXPECT_THAT(run({"objects", "impostors", "list"}).out, HasSubstr("strangers.jpg"));
  EXPECT_EQ(run({"objects", "impostors", "remove", "1"}).status, 0);
}

TEST_F(Commands, TheManualAndCompletionNameEveryCommand) {
  const std::string manual = run({"man"}).out;
  EXPECT_THAT(manual, StartsWith(".TH POSEVOTE 1"));
  EXPECT_THAT(manual, HasSubstr("posevote objects rename"));
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const std::string script = run({"completion", shell}).out;
    for (const char* word : {"teach", "recognize", "objects", "annotate", "background"})
      EXPECT_THAT(script, HasSubstr(word)) << shell;
  }
}

TEST_F(Commands, BashCompletesCommandsOptionsAndNames) {
  teach_poster();
  const auto complete = [&](const std::string& words, int at) {
    write("script", "export POSEVOTE_DB='" + database() + "' PATH=\"" +
                        fs::path(POSEVOTE_PROGRAM).parent_path().string() + ":$PATH\"\n" +
                        "source <(posevote completion bash)\nCOMP_WORDS=(" + words +
                        ")\nCOMP_CWORD=" + std::to_string(at) +
                        "\n_posevote\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
    const std::string command = "bash '" + path("script") + "' > '" + path("reply") + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return content(path("reply"));
  };
  EXPECT_EQ(complete("posevote rec", 1), "recognize\n");
  EXPECT_EQ(complete("posevote objects ren", 2), "rename\n");
  EXPECT_EQ(complete("posevote teach --backg", 2), "--background\n");
  EXPECT_EQ(complete("posevote teach --features su", 3), "surf\n");
  EXPECT_EQ(complete("posevote objects show po", 3), "poster\n");
}

}  // namespace
}  // namespace posevote
