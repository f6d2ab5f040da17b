#include "posevote/feature/features.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "posevote/core/error.hpp"
#include "posevote/feature/made_pictures.hpp"
#include "posevote/feature/picture.hpp"

namespace posevote {
namespace {

FeatureOptions options_of(const std::string& kind, int max_features = 0) {
  FeatureOptions options;
  options.kind = kind;
  options.max_features = max_features;
  return options;
}

ErrorCode code_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::io;
}

double largest_difference(const Features& a, const Features& b) {
  if (a.size() != b.size()) return 1e9;
  double worst = a.empty() ? 0 : cv::norm(a.descriptors, b.descriptors, cv::NORM_INF);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Keypoint &p = a.keypoints[i], &q = b.keypoints[i];
    for (const double d : {p.x - q.x, p.y - q.y, p.scale - q.scale, p.angle - q.angle})
      worst = std::max(worst, std::abs(d));
  }
  return worst;
}

TEST(ToGrey, SharesAnEightBitGreyPicture) {
  const cv::Mat grey = made::texture(20, 10);
  EXPECT_EQ(to_grey(grey).data, grey.data);
}

TEST(ToGrey, IgnoresAlphaAndScalesSixteenBits) {
  const cv::Mat bgr(4, 5, CV_8UC3, cv::Scalar(10, 200, 60));
  const cv::Mat bgra(4, 5, CV_8UC4, cv::Scalar(10, 200, 60, 0));
  const cv::Mat deep(4, 5, CV_16UC3, cv::Scalar(10 * 256, 200 * 256, 60 * 256));
  const cv::Mat expected = to_grey(bgr);
  EXPECT_EQ(expected.type(), CV_8UC1);
  EXPECT_EQ(cv::norm(expected, to_grey(bgra), cv::NORM_INF), 0);
  EXPECT_LE(cv::norm(expected, to_grey(deep), cv::NORM_INF), 1);
  const cv::Mat white(1, 1, CV_16UC1, cv::Scalar(65535));
  EXPECT_EQ(to_grey(white).at<std::uint8_t>(0, 0), 255);
}

TEST(ToGrey, RefusesOtherTypesAndPassesEmptyOn) {
  EXPECT_TRUE(to_grey(cv::Mat()).empty());
  for (const int type : {CV_32FC1, CV_8UC2, CV_8SC1, CV_64FC3})
    EXPECT_EQ(code_of([&] { (void)to_grey(cv::Mat(2, 2, type, cv::Scalar::all(1))); }),
              ErrorCode::invalid_argument);
}

TEST(FeatureOptions, SignatureTellsKindsApartAndIgnoresLimits) {
  FeatureOptions surf = options_of("surf"), sift = options_of("sift"), upright = surf,
                 limited = surf;
  upright.surf.upright = true;
  limited.max_features = 5;
  limited.surf.hessian_threshold = 1000;
  EXPECT_NE(surf.signature(), sift.signature());
  EXPECT_NE(surf.signature(), upright.signature());
  EXPECT_EQ(surf.signature(), limited.signature());
}

TEST(MakeExtractor, RefusesBadOptions) {
  EXPECT_EQ(code_of([] { (void)make_extractor(options_of("orb")); }), ErrorCode::invalid_argument);
  FeatureOptions options;
  options.surf.octaves = 0;
  EXPECT_EQ(code_of([&] { (void)make_extractor(options); }), ErrorCode::invalid_argument);
}

#if !POSEVOTE_WITH_SURF
TEST(MakeExtractor, SaysThatTheBuildHasNoSurf) {
  EXPECT_EQ(code_of([] { (void)make_extractor(options_of("surf")); }), ErrorCode::unsupported);
}
#endif

// What every kind of features must keep to.
class AnyExtractor : public testing::TestWithParam<const char*> {};

TEST_P(AnyExtractor, RowsHaveLengthOneAndStrongestComeFirst) {
  const auto features = make_extractor(options_of(GetParam()))->extract(made::texture(240, 180));
  ASSERT_GT(features.size(), 30U);
  ASSERT_EQ(features.descriptors.rows, static_cast<int>(features.size()));
  EXPECT_EQ(features.descriptors.type(), CV_32F);
  EXPECT_TRUE(features.descriptors.isContinuous());
  EXPECT_TRUE(std::ranges::is_sorted(features.keypoints, comes_before));
  for (int i = 0; i < features.descriptors.rows; ++i)
    EXPECT_NEAR(cv::norm(features.descriptors.row(i)), 1, 1e-4);
  for (const Keypoint& point : features.keypoints) {
    EXPECT_GT(point.scale, 0);
    EXPECT_GE(point.angle, -std::numbers::pi_v<float>);
    EXPECT_LT(point.angle, std::numbers::pi_v<float>);
  }
}

TEST_P(AnyExtractor, MaxFeaturesKeepsExactlyTheStrongest) {
  const cv::Mat picture = made::texture(240, 180);
  const auto all = make_extractor(options_of(GetParam()))->extract(picture);
  for (const int limit : {1, 2, 17, static_cast<int>(all.size()), 100000}) {
    const auto some = make_extractor(options_of(GetParam(), limit))->extract(picture);
    ASSERT_EQ(some.size(), std::min<std::size_t>(limit, all.size()));
    for (std::size_t i = 0; i < some.size(); ++i)
      EXPECT_EQ(some.keypoints[i].response, all.keypoints[i].response);
  }
}

#if POSEVOTE_WITH_SURF
TEST(MakeExtractor, LargePicturesMayKeepMoreInProportion) {
  const cv::Mat large = made::texture(2000, 2000);
  FeatureOptions options = options_of("surf", 40), strict = options;
  strict.more_in_large = false;
  EXPECT_EQ(make_extractor(options)->extract(large).size(), 80U);
  EXPECT_EQ(make_extractor(strict)->extract(large).size(), 40U);
}
#endif

TEST_P(AnyExtractor, PicturesOfAnySizeAreTaken) {
  const auto extractor = make_extractor(options_of(GetParam()));
  EXPECT_TRUE(extractor->extract(cv::Mat()).empty());
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(1, 300), cv::Size(300, 1), cv::Size(2, 3),
                              cv::Size(8, 8), cv::Size(9, 9), cv::Size(15, 40), cv::Size(33, 34)}) {
    const auto features = extractor->extract(made::texture(size.width, size.height));
    for (const Keypoint& point : features.keypoints) {
      EXPECT_GE(point.x, -0.5F);
      EXPECT_LE(point.x, static_cast<float>(size.width) - 0.5F);
    }
  }
}

TEST_P(AnyExtractor, ColourAlphaAndDepthChangeNothing) {
  const auto extractor = make_extractor(options_of(GetParam()));
  const cv::Mat grey = made::texture(160, 120);
  cv::Mat bgr, bgra, deep;
  cv::cvtColor(grey, bgr, cv::COLOR_GRAY2BGR);
  cv::cvtColor(grey, bgra, cv::COLOR_GRAY2BGRA);
  grey.convertTo(deep, CV_16U, 256);
  const auto expected = extractor->extract(grey);
  ASSERT_FALSE(expected.empty());
  for (const cv::Mat& other : {bgr, bgra, deep})
    EXPECT_EQ(largest_difference(expected, extractor->extract(other)), 0);
}

TEST_P(AnyExtractor, APartOfALargerPictureIsReadWithItsStride) {
  const auto extractor = make_extractor(options_of(GetParam()));
  const cv::Mat part = made::texture(300, 200)(cv::Rect(31, 17, 160, 120));
  const auto expected = extractor->extract(part.clone());
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(largest_difference(expected, extractor->extract(part)), 0);
}

TEST_P(AnyExtractor, MaskLeavesOutWhatItCovers) {
  const auto extractor = make_extractor(options_of(GetParam()));
  const cv::Mat picture = made::texture(240, 180);
  cv::Mat mask = cv::Mat::zeros(picture.size(), CV_8U);
  EXPECT_TRUE(extractor->extract(picture, mask).empty());
  mask.colRange(0, 120).setTo(1);
  const auto half = extractor->extract(picture, mask);
  ASSERT_FALSE(half.empty());
  for (const Keypoint& point : half.keypoints) EXPECT_LT(point.x, 120.5F);
  EXPECT_LT(half.size(), extractor->extract(picture).size());
}

TEST_P(AnyExtractor, RefusesMasksAndPicturesOfWrongShape) {
  const auto extractor = make_extractor(options_of(GetParam()));
  const cv::Mat picture = made::texture(60, 50);
  const auto use = [&](const cv::Mat& image, const cv::Mat& mask) {
    return code_of([&] { (void)extractor->extract(image, mask); });
  };
  EXPECT_EQ(use(picture, cv::Mat::ones(50, 61, CV_8U)), ErrorCode::invalid_argument);
  EXPECT_EQ(use(picture, cv::Mat::ones(50, 60, CV_32F)), ErrorCode::invalid_argument);
  EXPECT_EQ(use(cv::Mat::ones(50, 60, CV_32F), {}), ErrorCode::invalid_argument);
}

TEST_P(AnyExtractor, FlatPicturesHaveNoFeatures) {
  const auto extractor = make_extractor(options_of(GetParam()));
  for (const int value : {0, 128, 255})
    EXPECT_TRUE(extractor->extract(cv::Mat(100, 120, CV_8U, cv::Scalar(value))).empty());
}

TEST_P(AnyExtractor, FindsASpotWhereItIs) {
  for (const cv::Point2d at : {cv::Point2d(60, 50), cv::Point2d(60.5, 50.25)}) {
    const auto features = make_extractor(options_of(GetParam(), 1))
                              ->extract(made::spot(120, 100, at.x, at.y, 4, false));
    ASSERT_EQ(features.size(), 1U);
    EXPECT_NEAR(features.keypoints[0].x, at.x, 0.1);
    EXPECT_NEAR(features.keypoints[0].y, at.y, 0.1);
  }
}

#if POSEVOTE_WITH_SURF
INSTANTIATE_TEST_SUITE_P(Kind, AnyExtractor, testing::Values("surf", "sift"),
                         [](const auto& test) { return std::string(test.param); });
#else
INSTANTIATE_TEST_SUITE_P(Kind, AnyExtractor, testing::Values("sift"),
                         [](const auto& test) { return std::string(test.param); });
#endif

}  // namespace
}  // namespace posevote
