#include "posevote/recognize/explain.hpp"

#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"
#include "posevote/recognize/trace.hpp"

namespace posevote {
namespace {

/// A picture full of print, another one for each seed.
cv::Mat printed(int seed, cv::Size size = {220, 220}) {
  cv::Mat picture(size, CV_8UC3, cv::Scalar::all(235));
  cv::RNG random(static_cast<std::uint64_t>(seed) * 0x9E3779B97F4A7C15U);
  for (int i = 0; i < 90; ++i)
    cv::circle(picture, {random.uniform(0, size.width), random.uniform(0, size.height)},
               random.uniform(3, 16),
               cv::Scalar(random.uniform(0, 256), random.uniform(0, 256), random.uniform(0, 256)),
               cv::FILLED);
  return picture;
}

std::shared_ptr<const View> taught(const cv::Mat& picture) {
  auto view = std::make_shared<View>();
  view->id = "1";
  view->image_size = picture.size();
  const auto w = static_cast<float>(picture.cols - 1), h = static_cast<float>(picture.rows - 1);
  view->outline = {{0, 0}, {w, 0}, {w, h}, {0, h}};
  view->centre = {w / 2, h / 2};
  view->patch = make_patch(picture, cv::Mat(picture.size(), CV_8U, cv::Scalar(255)));
  view->features = make_extractor(RecognizeOptions{}.feature)->extract(picture);
  return view;
}

class Explain : public testing::Test {
 protected:
  Recognizer recognizer_{
      std::make_shared<ModelSet>(
          RecognizeOptions{}.feature.signature(),
          std::vector<ObjectModel>{{"card", {taught(printed(1))}}, {"book", {taught(printed(2))}}}),
      RecognizeOptions{}};
  cv::Mat scene_{480, 640, CV_8UC3, cv::Scalar::all(120)};
};

TEST_F(Explain, AFoundObjectIsSaidWithItsCounts) {
  printed(1).copyTo(scene_(cv::Rect(100, 100, 220, 220)));
  const Explanation result = explain(recognizer_, scene_, "card");
  EXPECT_TRUE(result.found);
  EXPECT_EQ(result.stage, "found");
  ASSERT_TRUE(result.best);
  EXPECT_EQ(result.best->object, "card");
  EXPECT_GE(result.scene_features, result.similar);
  EXPECT_GE(result.similar, result.matched);
  EXPECT_GE(result.matched, result.largest_bin);
  EXPECT_GT(result.largest_bin, 4);
  EXPECT_EQ(result.matches.size(), result.vote_centres.size());
}

TEST_F(Explain, VotesMeetAtTheCentreOfAFoundObject) {
  printed(1).copyTo(scene_(cv::Rect(100, 100, 220, 220)));
  const Explanation result = explain(recognizer_, scene_, "card");
  const auto near = std::ranges::count_if(result.vote_centres, [](const cv::Point2f& centre) {
    return cv::norm(centre - cv::Point2f(210, 210)) < 20;
  });
  EXPECT_GT(2 * near, static_cast<std::ptrdiff_t>(result.vote_centres.size()));
}

TEST_F(Explain, AnEmptyTableHasNoFeatures) {
  const Explanation result = explain(recognizer_, scene_, "card");
  EXPECT_FALSE(result.found);
  EXPECT_EQ(result.stage, "features");
  EXPECT_FALSE(result.best);
}

TEST_F(Explain, AnAbsentObjectEndsBeforeAPoseAndNamesAnOption) {
  printed(2).copyTo(scene_(cv::Rect(100, 100, 220, 220)));
  const Explanation result = explain(recognizer_, scene_, "card");
  EXPECT_FALSE(result.found);
  EXPECT_THAT(result.stage, testing::AnyOf("similar", "ratio", "votes", "pose", "chance"));
  EXPECT_FALSE(result.reason.empty());
  auto options = recognizer_.options();
  const OptionList list = list_options(options);
  EXPECT_TRUE(std::ranges::any_of(list.fields(), [&](const OptionField& field) {
    return field.name == result.option;
  })) << result.option;
}

TEST_F(Explain, AnObjectOfWhichOnlyAPartLooksRightIsDoubtedForTheRest) {
  // A strip of the card, on another thing as large as the card.
  cv::Mat other = printed(3);
  printed(1)(cv::Rect(0, 0, 220, 60)).copyTo(other(cv::Rect(0, 0, 220, 60)));
  other.copyTo(scene_(cv::Rect(100, 100, 220, 220)));
  RecognizeOptions strict;
  strict.verify.false_alarms_per_1000_images = 1e-3;
  const Recognizer recognizer(recognizer_.models(), strict);
  const Explanation result = explain(recognizer, scene_, "card");
  EXPECT_FALSE(result.found);
  EXPECT_THAT(result.stage, testing::AnyOf("object", "place"));
  ASSERT_TRUE(result.best);
  EXPECT_EQ(result.option, "verify.false_alarms_per_1000_images");
}

TEST_F(Explain, OneTraceExplainsAllObjectsAsSeparateLooksDo) {
  printed(1).copyTo(scene_(cv::Rect(100, 100, 220, 220)));
  const Trace trace = recognizer_.trace(scene_);
  for (const std::string object : {"card", "book"}) {
    const Explanation from_trace = explain(trace, recognizer_.options(), object);
    const Explanation alone = explain(recognizer_, scene_, object);
    EXPECT_EQ(from_trace.stage, alone.stage);
    EXPECT_EQ(from_trace.reason, alone.reason);
    EXPECT_EQ(from_trace.matched, alone.matched);
  }
}

TEST_F(Explain, AnUnknownNameIsAnErrorThatNamesTheNearest) {
  try {
    static_cast<void>(explain(recognizer_, scene_, "crad"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::not_found);
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'card'?"));
  }
}

}  // namespace
}  // namespace posevote
