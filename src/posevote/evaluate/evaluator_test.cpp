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
  EXPECT_THROW(static_cast<void>(make_method("default", {{"nonsense", "1"}})), Error);
  EXPECT_THROW(static_cast<void>(make_method("no-preset", {})), Error);
}

}  // namespace
}  // namespace posevote
