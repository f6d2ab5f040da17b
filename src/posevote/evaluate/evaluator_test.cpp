#include "posevote/evaluate/evaluator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/made_dataset.hpp"
#include "posevote/evaluate/method.hpp"
#include "posevote/evaluate/results.hpp"

namespace posevote {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(TeachDataset, TeachesTheWholePictureUnderItsPath) {
  MadeDataset made(2);
  const TaughtDataset taught = teach_dataset(load_dataset(made.folder()), {});
  ASSERT_THAT(taught.models->views(), SizeIs(2));
  EXPECT_THAT(taught.refused, IsEmpty());
  EXPECT_EQ(taught.models->views()[1].view->id, "train/cover-1.png");
  EXPECT_EQ(taught.models->views()[1].view->image_size, cv::Size(160, 160));
}

TEST(TeachDataset, ReducesPicturesBeforeTeaching) {
  MadeDataset made(1);
  const TaughtDataset taught = teach_dataset(load_dataset(made.folder()), {}, 0, {}, 0.5);
  EXPECT_EQ(taught.models->views()[0].view->image_size, cv::Size(80, 80));
}

TEST(TeachDataset, ListsAViewThatCannotBeTaughtAndGoesOn) {
  MadeDataset made(2);
  cv::imwrite((made.folder() / "train/cover-0.png").string(),
              cv::Mat(160, 160, CV_8UC3, cv::Scalar::all(100)));
  const TaughtDataset taught = teach_dataset(load_dataset(made.folder()), {});
  ASSERT_THAT(taught.refused, SizeIs(1));
  EXPECT_EQ(taught.refused[0].object, "cover-0");
  EXPECT_THAT(taught.models->objects(), SizeIs(1));
}

TEST(TeachDataset, FailsForAMissingPicture) {
  MadeDataset made(1);
  std::filesystem::remove(made.folder() / "train/cover-0.png");
  EXPECT_THROW(static_cast<void>(teach_dataset(load_dataset(made.folder()), {})), Error);
}

TEST(TeachDataset, ComparesSilhouettesWithTheTrueOnes) {
  MadeDataset made(2);
  made.teach_first_by_background();
  const Dataset dataset = load_dataset(made.folder());
  const TaughtDataset taught = teach_dataset(dataset, {});
  ASSERT_THAT(taught.silhouettes, SizeIs(1));
  EXPECT_EQ(taught.silhouettes[0].object, "cover-0");
  EXPECT_GT(taught.silhouettes[0].fit.iou, 0.9);
  EXPECT_FALSE(taught.silhouettes[0].outline.empty());

  std::filesystem::copy_file(made.folder() / "train/background.png",
                             made.folder() / "train/cover-0.png",
                             std::filesystem::copy_options::overwrite_existing);
  const TaughtDataset refused = teach_dataset(dataset, {});
  ASSERT_THAT(refused.silhouettes, SizeIs(1));
  EXPECT_TRUE(refused.silhouettes[0].refused);
  EXPECT_DOUBLE_EQ(refused.silhouettes[0].fit.iou, 0);
}

TEST(ExplainWorst, SaysWhyAnObjectWasMissed) {
  MadeDataset made(2);
  made.add_test("found", 0);
  made.add_test("missed", -1, {{"objects", {{{"name", "cover-1"}, {"box", {100, 50, 160, 160}}}}}});
  const Dataset dataset = load_dataset(made.folder());
  const TaughtMethod taught(dataset, make_method("default", {}));
  Evaluation evaluation = taught.evaluate(dataset);
  taught.explain_worst(evaluation, 0);
  EXPECT_THAT(evaluation.explanations, IsEmpty());
  taught.explain_worst(evaluation, 5);
  ASSERT_THAT(evaluation.explanations, SizeIs(1));
  const auto& [question, answer] = *evaluation.explanations.begin();
  EXPECT_EQ(question.second, "cover-1");
  EXPECT_FALSE(answer.found);
  EXPECT_EQ(answer.stage, "features");
}

TEST(ExplainWorst, LeavesOutWhatIsNotTaughtOrCannotBeRead) {
  MadeDataset made(1);
  made.add_test("unknown", -1, {{"objects", {{{"name", "other"}, {"box", {0, 0, 50, 50}}}}}});
  made.add_test("gone", 0);
  const Dataset dataset = load_dataset(made.folder());
  std::filesystem::remove(made.folder() / "test-1.png");
  const TaughtMethod taught(dataset, make_method("default", {}));
  Evaluation evaluation = taught.evaluate(dataset);
  EXPECT_EQ(summarize("", dataset, evaluation.outcomes).asked, 2);
  taught.explain_worst(evaluation, 5);
  EXPECT_THAT(evaluation.explanations, IsEmpty());
}

TEST(RunTests, GivesTheSameForAnyNumberOfThreads) {
  MadeDataset made(2);
  for (int i = 0; i < 4; ++i) made.add_test("g", i % 3 - 1);
  const Dataset dataset = load_dataset(made.folder());
  Method method = make_method("default", {});
  method.jobs = 1;
  const TaughtMethod taught(dataset, method);
  method.jobs = 4;
  const TaughtMethod parallel(taught.taught(), method);
  EXPECT_EQ(to_json_lines(taught.evaluate(dataset)), to_json_lines(parallel.evaluate(dataset)));
}

TEST(RunTests, FindsWhatIsThere) {
  MadeDataset made(2);
  made.add_test("with", 0);
  made.add_test("with", 1);
  made.add_test("without", -1);
  const Dataset dataset = load_dataset(made.folder());
  const Evaluation evaluation = TaughtMethod(dataset, make_method("default", {})).evaluate(dataset);
  const Summary summary = summarize("", dataset, evaluation.outcomes);
  EXPECT_EQ(summary.asked, 2);
  EXPECT_EQ(summary.right, 2);
  EXPECT_EQ(summary.images, 3);
}

TEST(RunTests, NotesAPictureThatCannotBeRead) {
  MadeDataset made(1);
  made.add_test("g", 0);
  const Dataset dataset = load_dataset(made.folder());
  std::filesystem::remove(made.folder() / "test-0.png");
  const auto outcomes = run_tests(
      dataset, [](const cv::Mat&) { return RecognitionResult(); }, 1);
  EXPECT_THAT(outcomes[0].error, HasSubstr("test-0.png"));
  EXPECT_EQ(outcomes[0].score.asked, 1);
  EXPECT_THAT(outcomes[0].score.missed, SizeIs(1));
}

TEST(MakeMethod, SetsOptionsOfRecognitionAndTeaching) {
  const Method method =
      make_method("default", {{"feature.kind", "sift"}, {"teach.min_features", "12"}});
  EXPECT_EQ(method.recognize.feature.kind, "sift");
  EXPECT_EQ(method.teach.feature.kind, "sift");
  EXPECT_EQ(method.teach.min_features, 12);
  EXPECT_TRUE(method.teach.foreshortened);
  EXPECT_THROW(static_cast<void>(make_method("default", {{"nonsense", "1"}})), Error);
  EXPECT_THROW(static_cast<void>(make_method("no-preset", {})), Error);
}

TEST(MakeMethod, TeachesForThePaperAsThePaperDoes) {
  const Method paper = make_method("paper", {});
  EXPECT_FALSE(paper.teach.foreshortened);
  EXPECT_FALSE(paper.teach.only_repeatable);
  EXPECT_TRUE(make_method("paper", {{"teach.foreshortened", "true"}}).teach.foreshortened);
}

}  // namespace
}  // namespace posevote
