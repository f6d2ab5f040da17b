#include "posevote/evaluate/assistant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/made_dataset.hpp"

namespace posevote {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

auto problem(bool is_error, const std::string& where, const std::string& what) {
  return AllOf(Field(&DatasetProblem::is_error, is_error),
               Field(&DatasetProblem::where, HasSubstr(where)),
               Field(&DatasetProblem::what, HasSubstr(what)));
}

std::vector<DatasetProblem> errors_of(const std::filesystem::path& folder) {
  auto problems = check_dataset(folder);
  std::erase_if(problems, [](const DatasetProblem& p) { return !p.is_error; });
  return problems;
}

TEST(CheckDataset, FindsNothingWrongWithTheDemo) {
  EXPECT_THAT(check_dataset(POSEVOTE_SOURCE_DIR "/data/demo"), IsEmpty());
}

TEST(CheckDataset, FindsMissingAndDamagedPictures) {
  MadeDataset made(2);
  made.add_test("g", 0);
  std::filesystem::remove(made.folder() / "test-0.png");
  std::ofstream(made.folder() / "train/cover-1.png") << "no picture";
  EXPECT_THAT(errors_of(made.folder()),
              testing::UnorderedElementsAre(problem(true, "tests[0]", "test-0.png"),
                                            problem(true, "objects[1].views[0].image", "cover-1")));
}

TEST(CheckDataset, FindsBoxesOutside) {
  MadeDataset made(1);
  made.add_test("g", 0);
  auto& objects = made.document()["tests"][0]["objects"];
  objects.push_back({{"name", "cover-0"}, {"box", {500, 10, 50, 50}}});
  objects.push_back({{"name", "cover-0"}, {"box", {10, 10, 0, 50}}});
  objects.push_back({{"name", "cover-0"}, {"box", {350, 10, 100, 50}}});
  made.save();
  const auto problems = check_dataset(made.folder());
  EXPECT_THAT(problems, Contains(problem(true, "objects[1].box", "lies outside the picture")));
  EXPECT_THAT(problems, Contains(problem(true, "objects[2].box", "covers nothing")));
  EXPECT_THAT(problems, Contains(problem(false, "objects[3].box", "reaches beyond")));
}

TEST(CheckDataset, FindsNamesThatAreNeverTaughtOrAsked) {
  MadeDataset made(2);
  made.add_test("g", 0);
  made.document()["tests"][0]["objects"][0]["name"] = "cover-00";
  made.document()["twins"] = nlohmann::json::array({nlohmann::json::array({"cover-0", "nobody"})});
  made.save();
  const auto problems = check_dataset(made.folder());
  EXPECT_THAT(problems, Contains(problem(true, "tests[0].objects[0].name",
                                         "'cover-00' is never taught; did you mean 'cover-0'?")));
  EXPECT_THAT(problems, Contains(problem(false, "objects", "'cover-1' is never asked for")));
  EXPECT_THAT(problems, Contains(problem(false, "twins", "'nobody'")));
}

TEST(CheckDataset, ComparesTheSizesOfAViewsPictures) {
  MadeDataset made(1);
  cv::imwrite((made.folder() / "mask.png").string(), cv::Mat(5, 7, CV_8U, cv::Scalar(255)));
  made.document()["objects"][0]["views"][0]["mask"] = "mask.png";
  made.save();
  EXPECT_THAT(errors_of(made.folder()),
              testing::ElementsAre(problem(true, "objects[0].views[0].mask", "7x5")));
}

TEST(CheckDataset, HintsAtSlips) {
  MadeDataset made(1);
  made.add_test("g", 0);
  made.document()["tests"].push_back(made.document()["tests"][0]);
  made.document()["tests"][0]["grup"] = "x";
  made.document()["tests"].push_back(
      {{"image", "train/cover-0.png"}, {"objects", nlohmann::json::array()}});
  made.save();
  const auto problems = check_dataset(made.folder());
  EXPECT_THAT(problems, Contains(problem(false, "tests[1]", "is a test twice")));
  EXPECT_THAT(problems, Contains(problem(false, "tests[0]", "did you mean 'group'")));
  EXPECT_THAT(problems, Contains(problem(false, "tests[2]", "is taught too")));
}

void touch(const std::filesystem::path& path) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << "x";
}

TEST(MakeDataset, UnderstandsTheFolders) {
  const TemporaryFolder folder;
  for (const char* file :
       {"train/mug/y030.jpg", "train/mug/side_yaw-45.jpg", "train/mug/background.png",
        "train/book/front.JPG", "train/book/front-mask.png", "train/book/ivy2.jpg",
        "train/book/notes.txt", "test/table/1.jpg", "test/2.png"})
    touch(folder.path() / file);
  const Dataset dataset = parse_dataset(make_dataset(folder.path()), folder.path(), "made");
  ASSERT_EQ(dataset.objects.size(), 2U);
  const auto& book = dataset.objects[0].views;
  ASSERT_EQ(book.size(), 2U);
  EXPECT_EQ(book[0].mask, "train/book/front-mask.png");
  EXPECT_TRUE(std::isnan(book[1].yaw_deg)) << "a word that ends with y";
  const auto& mug = dataset.objects[1].views;
  ASSERT_EQ(mug.size(), 2U);
  EXPECT_EQ(mug[0].yaw_deg, -45);
  EXPECT_EQ(mug[1].yaw_deg, 30);
  EXPECT_EQ(mug[1].background, "train/mug/background.png");
  ASSERT_EQ(dataset.tests.size(), 2U);
  EXPECT_EQ(dataset.tests[0].group, "");
  EXPECT_EQ(dataset.tests[1].group, "table");
  EXPECT_EQ(dataset.name, folder.path().filename().string());
}

TEST(MakeDataset, RefusesAFolderWithoutPictures) {
  const TemporaryFolder folder;
  EXPECT_THROW(static_cast<void>(make_dataset(folder.path())), Error);
}

TEST(AddToDataset, AddsTestsAndObjectsAndKeepsTheRest) {
  MadeDataset made(1);
  made.add_test("g", 0);
  made.document()["note"] = "mine";
  made.save();
  TruthObject truth = parse_truth("cover-0=1,2.5,30,40");
  truth.visible = 0.5;
  replace_file(dataset_file(made.folder()),
               add_to_dataset(made.folder(), {"test-0.png", "", {truth}}));
  const std::string text = add_to_dataset(made.folder(), {"new.png", "other", {}});
  const Dataset dataset = parse_dataset(text, made.folder(), "made");
  ASSERT_EQ(dataset.tests.size(), 2U);
  EXPECT_EQ(dataset.tests[0].group, "g");
  ASSERT_EQ(dataset.tests[0].objects.size(), 2U);
  EXPECT_EQ(dataset.tests[0].objects[1].box, cv::Rect2d(1, 2.5, 30, 40));
  EXPECT_EQ(dataset.tests[0].objects[1].visible, 0.5);
  EXPECT_EQ(dataset.tests[1].group, "other");
  EXPECT_THAT(text, HasSubstr("\"note\": \"mine\""));
}

TEST(ParseTruth, RefusesWhatIsNoBox) {
  for (const char* text : {"mug", "=1,2,3,4", "mug=1,2,3", "mug=1,2,3,4,5", "mug=1,2,0,4",
                           "mug=a,2,3,4", "mug=1,2,3,"})
    EXPECT_THROW(static_cast<void>(parse_truth(text)), Error) << text;
}

TEST(ReplaceFile, LeavesNothingBehindWhenItFails) {
  const TemporaryFolder folder;
  EXPECT_THROW(replace_file(folder.path() / "no" / "file.json", "x"), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace posevote
