// posevote evaluate and posevote dataset on the real executable.
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "posevote/evaluate/made_dataset.hpp"
#include "program.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class EvaluateCommand : public Program {
 protected:
  // Two pictures with a cover each, one without.
  void SetUp() override {
    made_.add_test("with", 0);
    made_.add_test("with", 1);
    made_.add_test("without", -1);
  }
  // A picture that lacks what it is said to show.
  void add_missed() {
    made_.add_test("lost", -1,
                   {{"objects", {{{"name", "cover-1"}, {"box", {100, 50, 160, 160}}}}}});
  }
  Outcome evaluate(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"evaluate", set()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] std::string set() const { return made_.folder().string(); }

  MadeDataset made_{2};
};

TEST_F(EvaluateCommand, PrintsEachGroupWithIntervalsAndTimes) {
  const Outcome outcome = evaluate({});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* part : {"2 objects, 2 views", "95 %", "precision", "verify", "without"})
    EXPECT_THAT(outcome.out, HasSubstr(part));
  const json line = json::parse(evaluate({"--json", "--jobs", "1"}).out);
  EXPECT_EQ(line["all"]["asked"], 2);
  EXPECT_EQ(line["all"]["right"], 2);
  EXPECT_EQ(line["groups"].size(), 2U);
}

TEST_F(EvaluateCommand, WritesReportMarkdownAndEveryDetection) {
  add_missed();
  const Outcome outcome = evaluate({"--report", path("report"), "--markdown", path("page.md"),
                                    "--dump", path("lines.jsonl"), "--negatives", set()});
  EXPECT_EQ(outcome.status, 0) << "whatever the score: " << outcome.err;
  EXPECT_THAT(content(path("report/index.html")),
              AllOf(HasSubstr("Missed, best visible first (1)"), HasSubstr("Not found: ")));
  EXPECT_THAT(content(path("page.md")),
              AllOf(HasSubstr("of 3 objects in 4 pictures"), HasSubstr("- Missed: cover-1.")));
  EXPECT_THAT(content(path("lines.jsonl")), HasSubstr(R"("verdict":"missed")"));
}

TEST_F(EvaluateCommand, IsAGateOnRequest) {
  EXPECT_EQ(evaluate({"--require", "recall=1,false_positives=0"}).status, 0);
  add_missed();
  expect_failure(evaluate({"--require", "recall=0.9"}), 1, {"recall", "0.9"});
}

TEST_F(EvaluateCommand, ComparesSweepsAndReproduces) {
  EXPECT_THAT(evaluate({"--compare", "opencv-sift,opencv-orb"}).out,
              AllOf(HasSubstr("opencv-sift"), HasSubstr("opencv-orb")));
  EXPECT_THAT(evaluate({"--sweep", "blur", "--groups", "with"}).out, HasSubstr("blur"));
  EXPECT_THAT(evaluate({"--table", "table1"}).out, AllOf(HasSubstr("697"), HasSubstr("783")));
}

TEST_F(EvaluateCommand, RefusesWhatIsNoDataset) {
  expect_failure(run({"evaluate", path("none")}), 1, {path("none")});
  fs::create_directory(path("broken"));
  const std::string file = write("broken/dataset.json", std::string("{\"name\": "));
  expect_failure(run({"evaluate", path("broken")}), 1, {file});
  write("broken/dataset.json", std::string(R"({"name": "x", "objects": [{"views": []}]})"));
  expect_failure(run({"evaluate", path("broken")}), 1, {file, "objects[0].name"});
  fs::remove(made_.folder() / "train/cover-0.png");
  expect_failure(evaluate({}), 1, {"cover-0.png"});
}

TEST_F(EvaluateCommand, GoesOnWithoutATestPictureThatCannotBeRead) {
  fs::remove(made_.folder() / "test-0.png");
  const Outcome outcome = evaluate({"--json"});
  expect_failure(outcome, 1, {"test-0.png"});
  EXPECT_EQ(json::parse(outcome.out)["all"]["right"], 1);
}

TEST_F(EvaluateCommand, RefusesWrongArguments) {
  const std::vector<std::vector<std::string>> wrong{
      {"--require", "recall"},      {"--require", "beauty=1"}, {"--table", "table9"},
      {"--sweep", "rain"},          {"--compare", "nobody"},   {"--preset", "nonsense"},
      {"--set", "match.max_ratio"}, {"--jobs", "-1"},          {"--limit", "few"}};
  for (const auto& arguments : wrong) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    expect_failure(evaluate(arguments), 2, {"--help"});
  }
  expect_failure(run({"evaluate"}), 2, {"--help"});
  expect_failure(evaluate({"--groups", "nothing*"}), 1, {"nothing*"});
  expect_failure(evaluate({"--table", "fig8"}), 1, {"fig8", "occlusion"});
}

TEST_F(EvaluateCommand, RefusesPlacesWhereNothingCanBeWritten) {
  const std::string precious = write("precious", std::string("text"));
  expect_failure(evaluate({"--report", precious, "--json"}), 1, {precious});
  expect_failure(evaluate({"--markdown", path("no/page.md"), "--json"}), 1, {path("no/page.md")});
  EXPECT_EQ(content(precious), "text");
}

class DatasetCommand : public Program {
 protected:
  void SetUp() override {
    fs::create_directories(path("set/train/poster"));
    fs::create_directories(path("set/test/table"));
    fs::copy(demo("train/poster/cover.jpg"), path("set/train/poster/cover.jpg"));
    fs::copy(small_scene(), path("set/test/table/1.jpg"));
  }
};

TEST_F(DatasetCommand, MakesADatasetThatCanBeEvaluated) {
  EXPECT_THAT(run({"dataset", "init", path("set")}).out, HasSubstr("1 objects, 1 tests"));
  EXPECT_EQ(run({"dataset", "add", path("set"), "test/table/1.jpg", "--object",
                 "poster=10,20,30,40", "--visible", "0.5"})
                .status,
            0);
  const json made = json::parse(content(path("set/dataset.json")));
  EXPECT_EQ(made["tests"][0]["objects"][0]["name"], "poster");
  EXPECT_EQ(made["tests"][0]["objects"][0]["visible"], 0.5);
  EXPECT_EQ(run({"dataset", "check", path("set")}).status, 0);
  EXPECT_EQ(json::parse(run({"evaluate", path("set"), "--json"}).out)["all"]["asked"], 1);
  expect_failure(run({"dataset", "init", path("set")}), 1, {"exists", "--force"});
}

TEST_F(DatasetCommand, FindsMistakes) {
  run({"dataset", "init", path("set")});
  run({"dataset", "add", path("set"), "test/table/1.jpg", "--object", "mug=300,20,300,40"});
  fs::remove(path("set/train/poster/cover.jpg"));
  const Outcome outcome = run({"dataset", "check", path("set")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("cover.jpg"), HasSubstr("mug"), HasSubstr("beyond the picture")));
}

TEST_F(DatasetCommand, RefusesWhatCannotBe) {
  expect_failure(run({"dataset", "init", path("none")}), 1, {path("none")});
  expect_failure(run({"dataset", "check", path("none")}), 1, {path("none")});
  run({"dataset", "init", path("set")});
  const std::string before = content(path("set/dataset.json"));
  expect_failure(run({"dataset", "add", path("set"), "test/table/9.jpg"}), 1, {"9.jpg"});
  expect_failure(run({"dataset", "add", path("set"), "test/table/1.jpg", "--object", "mug=1,2"}), 1,
                 {"mug=1,2"});
  EXPECT_EQ(content(path("set/dataset.json")), before);
}

}  // namespace
}  // namespace posevote
