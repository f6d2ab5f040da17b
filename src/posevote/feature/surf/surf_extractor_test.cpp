#include "posevote/feature/surf/surf_extractor.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <numbers>
#include <thread>
#include <tuple>

#include "posevote/feature/made_pictures.hpp"
#include "posevote/feature/surf/surf.hpp"

namespace {
std::atomic<long> allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size ? size : 1);
}
// Not inlined, so that the compiler does not see a `free` of what came from `new`.
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace posevote {
namespace {

constexpr double kPi = std::numbers::pi;

// Where the features of `view` are found again in `scene`, when scene = warped(view) by a
// similarity.
struct Followed {
  int asked = 0, repeated = 0, alike = 0;
};

double angle_between(double a, double b) {
  return std::abs(std::remainder(a - b, 2 * kPi));
}

Followed follow(const Features& view, const Features& scene, const cv::Matx23d& warp,
                cv::Size size) {
  const double zoom = std::hypot(warp(0, 0), warp(1, 0));
  const double turn = std::atan2(warp(1, 0), warp(0, 0));
  Followed result;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const Keypoint& point = view.keypoints[i];
    const cv::Vec2d at = warp * cv::Vec3d(point.x, point.y, 1);
    const double margin = 20 * point.scale * zoom;
    if (at[0] < margin || at[1] < margin || at[0] > size.width - margin ||
        at[1] > size.height - margin)
      continue;
    ++result.asked;
    bool repeated = false, alike = false;
    for (std::size_t k = 0; k < scene.size(); ++k) {
      const Keypoint& other = scene.keypoints[k];
      const double scale = point.scale * zoom;
      if (std::hypot(other.x - at[0], other.y - at[1]) > 0.5 * scale ||
          std::abs(std::log2(other.scale / scale)) > 0.35 || other.laplacian != point.laplacian)
        continue;
      repeated = true;
      alike |= angle_between(other.angle, point.angle + turn) < 0.2 &&
               cv::norm(view.descriptors.row(static_cast<int>(i)),
                        scene.descriptors.row(static_cast<int>(k))) < 0.35;
    }
    result.repeated += repeated;
    result.alike += alike;
  }
  return result;
}

class Warp : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(Warp, FeaturesFollowASimilarity) {
  const auto [degrees, zoom] = GetParam();
  const cv::Mat view = made::texture(320, 320);
  const cv::Size size(560, 560);
  cv::Mat warp = cv::getRotationMatrix2D({160, 160}, degrees, zoom);
  warp.at<double>(0, 2) += 120.4;
  warp.at<double>(1, 2) += 119.7;
  cv::Mat scene;
  cv::warpAffine(view, scene, warp, size, cv::INTER_CUBIC, cv::BORDER_REFLECT);

  FeatureOptions options;
  options.max_features = 300;
  const auto from = make_surf_extractor(options)->extract(view);
  options.max_features = 0;
  const auto found = follow(from, make_surf_extractor(options)->extract(scene), warp, size);
  ASSERT_GT(found.asked, 80);
  EXPECT_GT(found.repeated, found.asked * 0.7);
  EXPECT_GT(found.alike, found.repeated * 0.5);
}

INSTANTIATE_TEST_SUITE_P(Similarities, Warp,
                         testing::Values(std::tuple(0.0, 1.0), std::tuple(90.0, 1.0),
                                         std::tuple(180.0, 1.0), std::tuple(17.0, 1.0),
                                         std::tuple(-45.0, 1.0), std::tuple(0.0, 1.5),
                                         std::tuple(0.0, 0.8), std::tuple(130.0, 1.3)));

TEST(Surf, UprightLeavesTheAngleAtZero) {
  FeatureOptions options;
  options.surf.upright = true;
  const auto features = make_surf_extractor(options)->extract(made::texture(160, 120));
  ASSERT_FALSE(features.empty());
  for (const Keypoint& point : features.keypoints) EXPECT_EQ(point.angle, 0);
}

TEST(Surf, OrientationPointsUpTheGradient) {
  // A spot on a ramp: away from the spot's own symmetric gradients only the ramp is left.
  for (const double degrees : {0.0, 60.0, 135.0, 180.0, 200.0, 300.0}) {
    cv::Mat picture = made::spot(160, 160, 80, 80, 4, true);
    picture.convertTo(picture, CV_8U, 0.2, 100);
    for (int y = 0; y < picture.rows; ++y)
      for (int x = 0; x < picture.cols; ++x) {
        const double ramp =
            std::cos(degrees * kPi / 180) * (x - 80) + std::sin(degrees * kPi / 180) * (y - 80);
        auto& pixel = picture.at<std::uint8_t>(y, x);
        pixel = cv::saturate_cast<std::uint8_t>(pixel + ramp);
      }
    FeatureOptions options;
    options.max_features = 1;
    const auto features = make_surf_extractor(options)->extract(picture);
    ASSERT_EQ(features.size(), 1U);
    EXPECT_LT(angle_between(features.keypoints[0].angle, degrees * kPi / 180), 0.25) << degrees;
  }
}

bool are_identical(const Features& a, const Features& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Keypoint &p = a.keypoints[i], &q = b.keypoints[i];
    if (std::tie(p.x, p.y, p.scale, p.angle, p.response, p.laplacian) !=
        std::tie(q.x, q.y, q.scale, q.angle, q.response, q.laplacian))
      return false;
  }
  return a.empty() || cv::norm(a.descriptors, b.descriptors, cv::NORM_INF) == 0;
}

TEST(Surf, AnyNumberOfThreadsGivesTheSameBits) {
  const cv::Mat picture = made::texture(301, 203);
  FeatureOptions options;
  for (const int limit : {0, 100}) {
    options.max_features = limit;
    options.surf.threads = 1;
    const auto expected = make_surf_extractor(options)->extract(picture);
    for (const int threads : {2, 3, 8, 0}) {
      options.surf.threads = threads;
      EXPECT_TRUE(are_identical(make_surf_extractor(options)->extract(picture), expected))
          << threads;
    }
  }
}

TEST(Surf, AllocatesNoMoreForManyKeyPointsThanForFewOnceItsBuffersAreThere) {
  const cv::Mat picture = made::texture(320, 240);
  for (const int threads : {1, 2})
    for (const bool spread : {false, true}) {
      surf::Workspace workspace;
      FeatureOptions options;
      options.surf.threads = threads;
      options.surf.spread = spread;
      const auto count = [&](int limit) {
        options.max_features = limit;
        const long before = allocations;
        const auto features = workspace.extract(picture, {}, options);
        const long made = allocations - before;
        EXPECT_EQ(features.size(), static_cast<std::size_t>(limit));
        return made;
      };
      (void)count(400);
      const long few = count(5);
      EXPECT_EQ(count(400), few);
      EXPECT_LT(few, 20);
    }
}

TEST(Surf, OneExtractorServesManyThreadsAndPicturesOfAllSizes) {
  const auto extractor = make_surf_extractor(FeatureOptions{});
  std::vector<cv::Mat> pictures;
  std::vector<Features> expected;
  for (const int width : {300, 40, 1, 160}) {
    pictures.push_back(made::texture(width, 120));
    expected.push_back(make_surf_extractor(FeatureOptions{})->extract(pictures.back()));
  }
  std::vector<std::jthread> threads;
  threads.reserve(4);
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 8; ++i) {
        const std::size_t k = static_cast<std::size_t>(t + i) % pictures.size();
        EXPECT_TRUE(are_identical(extractor->extract(pictures[k]), expected[k]));
      }
    });
}

TEST(Surf, DoubleSizeTakesEmptyAndTinyPictures) {
  FeatureOptions options;
  options.surf.double_size = true;
  const auto extractor = make_surf_extractor(options);
  for (const cv::Size size : {cv::Size(0, 0), cv::Size(1, 1), cv::Size(3, 40)})
    EXPECT_TRUE(extractor->extract(cv::Mat(size, CV_8U, cv::Scalar(7))).empty());
}

TEST(Surf, DoubleSizeFindsASpotTooSmallOtherwise) {
  const cv::Mat picture = made::spot(80, 60, 40.3, 30.6, 1.2, true);
  FeatureOptions options;
  options.max_features = 1;
  EXPECT_TRUE(make_surf_extractor(options)->extract(picture).empty());
  options.surf.double_size = true;
  const auto features = make_surf_extractor(options)->extract(picture);
  ASSERT_EQ(features.size(), 1U);
  EXPECT_NEAR(features.keypoints[0].x, 40.3, 0.2);
  EXPECT_NEAR(features.keypoints[0].y, 30.6, 0.2);
}

TEST(Surf, SpreadTakesFeaturesOfWeakPartsToo) {
  cv::Mat picture = made::texture(400, 200);
  cv::Mat weak = picture.colRange(200, 400);
  weak.convertTo(weak, CV_8U, 0.5, 64);
  FeatureOptions options;
  options.surf.hessian_threshold = 1;
  options.max_features = 60;
  const auto count_weak = [&] {
    const auto features = make_surf_extractor(options)->extract(picture);
    EXPECT_EQ(features.size(), 60U);
    return std::ranges::count_if(features.keypoints, [](const Keypoint& k) { return k.x > 210; });
  };
  const auto before = count_weak();
  options.surf.spread = true;
  EXPECT_GT(count_weak(), before + 10);
}

TEST(Surf, NegativePictureTurnsTheSign) {
  const cv::Mat picture = made::texture(160, 120);
  FeatureOptions options;
  options.surf.smooth = false;  // rounds halves up, in the negative too
  const auto extractor = make_surf_extractor(options);
  const auto positive = extractor->extract(picture);
  const auto negative = extractor->extract(255 - picture);
  ASSERT_EQ(positive.size(), negative.size());
  for (std::size_t i = 0; i < positive.size(); ++i)
    EXPECT_EQ(positive.keypoints[i].laplacian, -negative.keypoints[i].laplacian);
}

TEST(Surf, BrightnessAndContrastHardlyChangeTheDescriptors) {
  const cv::Mat picture = made::texture(240, 180);
  cv::Mat pale;
  picture.convertTo(pale, CV_8U, 0.5, 90);
  FeatureOptions options;
  options.max_features = 150;
  const auto strong = make_surf_extractor(options)->extract(picture);
  options.max_features = 0;
  const auto weak = make_surf_extractor(options)->extract(pale);
  const auto found = follow(strong, weak, cv::Matx23d(1, 0, 0, 0, 1, 0), picture.size());
  ASSERT_GT(found.asked, 10);
  EXPECT_GE(found.alike, found.asked * 0.9);
}

}  // namespace
}  // namespace posevote
