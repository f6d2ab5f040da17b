#include "posevote/recognize/recognizer.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

const std::string kData = POSEVOTE_SOURCE_DIR "/data/demo/";

FeatureOptions features() {
  FeatureOptions options;
  options.max_features = 600;
  return options;
}

RecognizeOptions options_of(const std::string& preset = "default") {
  RecognizeOptions options = make_preset(preset);
  options.feature = features();
  return options;
}

std::shared_ptr<View> whole_picture(const cv::Mat& picture) {
  auto view = std::make_shared<View>();
  view->id = "1";
  view->image_size = picture.size();
  const auto w = static_cast<float>(picture.cols - 1), h = static_cast<float>(picture.rows - 1);
  view->outline = {{0, 0}, {w, 0}, {w, h}, {0, h}};
  view->centre = {w / 2, h / 2};
  view->patch = make_patch(picture, cv::Mat(picture.size(), CV_8U, cv::Scalar(255)));
  view->features = make_extractor(features())->extract(picture);
  return view;
}

cv::Mat poster() {
  static const cv::Mat picture = [] {
    const auto files = kData + "train/poster/*.jpg";
    std::vector<cv::String> found;
    cv::glob(files, found);
    cv::Mat image = cv::imread(found.at(0));
    cv::resize(image, image, {240, 240 * image.rows / image.cols}, 0, 0, cv::INTER_AREA);
    return image;
  }();
  return picture;
}

std::shared_ptr<const ModelSet> models_of(std::vector<ObjectModel> objects) {
  return std::make_shared<ModelSet>(features().signature(), std::move(objects));
}

std::shared_ptr<const ModelSet> poster_model() {
  return models_of({{"poster", {whole_picture(poster())}}});
}

/// The poster on a grey ground under an affine transform of its pixels.
cv::Mat scene_with(const std::vector<cv::Matx23d>& places, cv::Size size = {800, 640}) {
  cv::Mat scene(size, CV_8UC3, cv::Scalar(120, 125, 130));
  for (const auto& place : places)
    cv::warpAffine(poster(), scene, place, size, cv::INTER_LINEAR, cv::BORDER_TRANSPARENT);
  return scene;
}

cv::Matx23d turned(double degrees, double scale, cv::Point2d centre) {
  const double a = degrees * std::numbers::pi / 180;
  const double c = scale * std::cos(a), s = scale * std::sin(a);
  const double x = poster().cols / 2.0, y = poster().rows / 2.0;
  return {c, -s, centre.x - c * x + s * y, s, c, centre.y - s * x - c * y};
}

double corner_error(const Detection& detection, const cv::Matx23d& truth) {
  double worst = 0;
  const std::vector<cv::Point2f> corners = {{0, 0}, {239, 0}, {239, 239}, {0, 239}};
  for (const auto& corner : corners) {
    const cv::Point2d expected(truth(0, 0) * corner.x + truth(0, 1) * corner.y + truth(0, 2),
                               truth(1, 0) * corner.x + truth(1, 1) * corner.y + truth(1, 2));
    const cv::Point2d found = transform_point(detection.scene_from_view, corner);
    worst = std::max(worst, cv::norm(found - expected));
  }
  return worst;
}

TEST(Recognizer, FindsAnObjectUnderRotationAndScaleAlsoUpsideDown) {
  const Recognizer recognizer(poster_model(), options_of());
  for (const auto& [degrees, scale] :
       {std::pair{0.0, 1.0}, {180.0, 1.0}, {37.0, 0.7}, {-100.0, 1.4}}) {
    const auto place = turned(degrees, scale, {400, 320});
    const auto result = recognizer.recognize(scene_with({place}));
    ASSERT_EQ(result.detections.size(), 1U) << degrees;
    EXPECT_EQ(result.detections[0].object, "poster");
    EXPECT_LT(corner_error(result.detections[0], place), 4) << degrees;
    EXPECT_GT(result.detections[0].probability, 0.99);
  }
}

TEST(Recognizer, FindsAFaceThatIsSeenFromAbove) {
  const Recognizer recognizer(poster_model(), options_of());
  for (const double height : {0.7, 0.6}) {
    const cv::Matx23d place(1, 0, 280, 0, height, 200);
    const auto result = recognizer.recognize(scene_with({place}));
    ASSERT_EQ(result.detections.size(), 1U) << height;
    EXPECT_LT(corner_error(result.detections[0], place), 4) << height;
  }
}

/// Nothing in it is its own mirror picture, unlike the rocket of the poster or the bowl of the
/// muesli.
cv::Mat triangles() {
  cv::Mat picture(240, 240, CV_8UC3, cv::Scalar(128, 128, 128));
  cv::RNG random(5);
  for (int i = 0; i < 150; ++i) {
    std::vector<cv::Point> corners(3);
    const cv::Point start(random.uniform(0, 240), random.uniform(0, 240));
    for (cv::Point& corner : corners)
      corner = start + cv::Point(random.uniform(-25, 25), random.uniform(-25, 25));
    const cv::Scalar colour(random.uniform(0, 256), random.uniform(0, 256), random.uniform(0, 256));
    cv::fillConvexPoly(picture, corners, colour, cv::LINE_AA);
  }
  return picture;
}

TEST(Recognizer, DoesNotTakeTheMirrorPictureForTheObject) {
  const Recognizer recognizer(models_of({{"triangles", {whole_picture(triangles())}}}),
                              options_of());
  cv::Mat mirrored;
  cv::flip(triangles(), mirrored, 1);
  EXPECT_EQ(recognizer.recognize(triangles()).detections.size(), 1U);
  EXPECT_TRUE(recognizer.recognize(mirrored).detections.empty());
}

/// Two flavours: one print but for a field.
cv::Mat flavour(const cv::Scalar& colour) {
  cv::Mat pack = triangles();
  cv::rectangle(pack, {90, 90, 70, 50}, colour, cv::FILLED);
  return pack;
}

TEST(Recognizer, ThePartInWhichLookAlikesDifferDecides) {
  const cv::Mat mint = flavour({90, 200, 80}), cherry = flavour({60, 40, 210});
  const Recognizer recognizer(
      models_of({{"mint", {whole_picture(mint)}}, {"cherry", {whole_picture(cherry)}}}),
      options_of());
  for (const auto& [name, pack] : {std::pair{"mint", mint}, {"cherry", cherry}}) {
    cv::Mat scene(480, 640, CV_8UC3, cv::Scalar(120, 125, 130));
    pack.copyTo(scene(cv::Rect(150, 100, pack.cols, pack.rows)));
    const auto result = recognizer.recognize(scene);
    ASSERT_EQ(result.detections.size(), 1U) << name;
    EXPECT_EQ(result.detections[0].object, name);
    EXPECT_TRUE(result.detections[0].alternatives.empty()) << name;
  }
}

TEST(Recognizer, OneThingTaughtUnderTwoNamesIsReportedWithBoth) {
  const Recognizer recognizer(
      models_of({{"cup", {whole_picture(poster())}}, {"mug", {whole_picture(poster())}}}),
      options_of());
  const auto result = recognizer.recognize(scene_with({turned(10, 0.9, {400, 320})}));
  ASSERT_EQ(result.detections.size(), 1U);
  ASSERT_EQ(result.detections[0].alternatives.size(), 1U);
  EXPECT_NE(result.detections[0].object, result.detections[0].alternatives[0]);
}

TEST(Recognizer, ReportsEachOfTwoCopiesOnce) {
  const Recognizer recognizer(poster_model(), options_of());
  const auto left = turned(0, 0.9, {200, 320}), right = turned(15, 0.9, {560, 320});
  const auto result = recognizer.recognize(scene_with({left, right}));
  ASSERT_EQ(result.detections.size(), 2U);
  const bool swapped = result.detections[0].box.x > result.detections[1].box.x;
  EXPECT_LT(corner_error(result.detections[swapped ? 1 : 0], left), 5);
  EXPECT_LT(corner_error(result.detections[swapped ? 0 : 1], right), 5);
}

TEST(Recognizer, FindsAnObjectWhoseCentreIsOutsideThePicture) {
  const Recognizer recognizer(poster_model(), options_of());
  const auto place = turned(0, 1.6, {-30, 320});
  const auto result = recognizer.recognize(scene_with({place}));
  ASSERT_EQ(result.detections.size(), 1U);
  EXPECT_LT(result.detections[0].box.x, 0);
  EXPECT_LT(corner_error(result.detections[0], place), 12);
}

TEST(Recognizer, FindsNothingWhereTheObjectIsNot) {
  const Recognizer recognizer(poster_model(), options_of());
  for (const char* name : {"test/strangers.jpg", "test/newcomers.jpg"})
    EXPECT_TRUE(recognizer.recognize(cv::imread(kData + name)).detections.empty()) << name;
}

TEST(Recognizer, TakesPicturesOfEveryKind) {
  const Recognizer recognizer(poster_model(), options_of());
  const cv::Mat scene = scene_with({turned(0, 1, {400, 320})});
  cv::Mat grey, bgra, deep;
  cv::cvtColor(scene, grey, cv::COLOR_BGR2GRAY);
  cv::cvtColor(scene, bgra, cv::COLOR_BGR2BGRA);
  scene.convertTo(deep, CV_16U, 256);
  for (const cv::Mat& picture : {grey, bgra, deep})
    EXPECT_EQ(recognizer.recognize(picture).detections.size(), 1U);
  EXPECT_TRUE(recognizer.recognize(cv::Mat(1, 1, CV_8U, cv::Scalar(7))).detections.empty());
}

TEST(Recognizer, KnowsNothingWithoutObjects) {
  const Recognizer recognizer(models_of({}), options_of());
  const auto result = recognizer.recognize(scene_with({turned(0, 1, {400, 320})}));
  EXPECT_TRUE(result.detections.empty());
  EXPECT_GT(result.counts.features, 0);
}

TEST(Recognizer, ThePapersPresetFindsThePlainCase) {
  const Recognizer recognizer(poster_model(), options_of("paper"));
  const auto place = turned(20, 1, {400, 320});
  const auto result = recognizer.recognize(scene_with({place}));
  ASSERT_EQ(result.detections.size(), 1U);
  EXPECT_GE(result.detections[0].confidence, 0.15);
  EXPECT_LT(corner_error(result.detections[0], place), 4);
}

TEST(Recognizer, SwapsItsObjectsWhileItRuns) {
  Recognizer recognizer(models_of({}), options_of());
  const cv::Mat scene = scene_with({turned(0, 1, {400, 320})});
  const auto models = poster_model();
  std::vector<std::size_t> found(4);
  {
    std::jthread swapper([&] { recognizer.set_models(models); });
    for (auto& count : found) count = recognizer.recognize(scene).detections.size();
  }
  for (const auto count : found) EXPECT_LE(count, 1U);
  EXPECT_EQ(recognizer.recognize(scene).detections.size(), 1U);
}

TEST(Recognizer, GivesTheSameAnswerAgain) {
  const Recognizer recognizer(poster_model(), options_of());
  const cv::Mat scene = scene_with({turned(33, 0.8, {400, 320})});
  const auto first = recognizer.recognize(scene), second = recognizer.recognize(scene);
  ASSERT_EQ(first.detections.size(), second.detections.size());
  EXPECT_EQ(first.detections[0].log10_false_alarms, second.detections[0].log10_false_alarms);
}

TEST(Recognizer, GivesTheSameAnswerForAnyNumberOfThreads) {
  const cv::Mat scene = scene_with({turned(0, 0.9, {200, 320}), turned(15, 0.9, {560, 320})});
  RecognizeOptions options = options_of();
  const auto one = Recognizer(poster_model(), options).recognize(scene);
  ASSERT_EQ(one.detections.size(), 2U);
  for (const int threads : {0, 2, 3, 64}) {
    options.threads = threads;
    const auto several = Recognizer(poster_model(), options).recognize(scene);
    ASSERT_EQ(several.detections.size(), one.detections.size()) << threads;
    EXPECT_EQ(several.counts.matched, one.counts.matched);
    for (std::size_t i = 0; i < one.detections.size(); ++i) {
      EXPECT_EQ(several.detections[i].log10_false_alarms, one.detections[i].log10_false_alarms);
      EXPECT_EQ(several.detections[i].probability, one.detections[i].probability);
      EXPECT_EQ(several.detections[i].outline, one.detections[i].outline);
    }
  }
}

TEST(Recognizer, ATimeBudgetThatIsSpentLeavesAnIncompleteResult) {
  RecognizeOptions options = options_of();
  const cv::Mat scene = scene_with({turned(0, 1, {400, 320})});
  options.deadline_ms = 1e-3;  // over before the first feature is matched
  const auto nothing = Recognizer(poster_model(), options).recognize(scene);
  EXPECT_TRUE(nothing.incomplete);
  EXPECT_TRUE(nothing.detections.empty());
  EXPECT_GT(nothing.counts.features, 0);
  options.deadline_ms = 1e6;
  const auto all = Recognizer(poster_model(), options).recognize(scene);
  EXPECT_FALSE(all.incomplete);
  EXPECT_EQ(all.detections.size(), 1U);
  EXPECT_EQ(all.counts.matched,
            Recognizer(poster_model(), options_of()).recognize(scene).counts.matched);
}

TEST(Recognizer, AnswersTheSameWithWhatAnotherOnePrepared) {
  auto view = whole_picture(poster());
  view->hash = "poster";
  const auto models = models_of({{"poster", {view}}});
  const Recognizer first(models, options_of());
  const Recognizer second(models, options_of(), first.save_prepared());
  EXPECT_GT(first.index_statistics().assigned, 0U);
  EXPECT_EQ(second.index_statistics().assigned, 0U);
  const cv::Mat scene = scene_with({turned(33, 0.8, {400, 320})});
  EXPECT_EQ(first.recognize(scene).detections.at(0).log10_false_alarms,
            second.recognize(scene).detections.at(0).log10_false_alarms);
}

TEST(Recognizer, RefusesFeaturesOfAnotherKindAndOptionsOutOfRange) {
  RecognizeOptions sift = options_of();
  sift.feature.kind = features().kind == "surf" ? "sift" : "surf";
  EXPECT_THROW(Recognizer(poster_model(), sift), Error);
  RecognizeOptions wrong = options_of();
  wrong.match.max_ratio = -1;
  EXPECT_THROW(Recognizer(poster_model(), wrong), Error);
}

TEST(MakePreset, NamesTheNearestForAWrongName) {
  try {
    (void)make_preset("papr");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'paper'"));
  }
}

}  // namespace
}  // namespace posevote
