#include "posevote/evaluate/silhouette.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

cv::Mat mask_of(const cv::Rect& area) {
  cv::Mat mask = cv::Mat::zeros(20, 20, CV_8U);
  mask(area).setTo(255);
  return mask;
}

cv::Mat plain(int level) {
  return {20, 20, CV_8UC3, cv::Scalar::all(level)};
}

SilhouetteCase with_fit(const SilhouetteFit& fit) {
  SilhouetteCase result;
  result.fit = fit;
  return result;
}

TEST(CompareSilhouettes, CountsWhatIsTakenWronglyAndWhatOfItIsDark) {
  // 10 x 10 px; 10 px too wide: half of them in shadow, half as bright as the background.
  cv::Mat picture = plain(100);
  picture(cv::Rect(10, 0, 1, 5)).setTo(cv::Scalar::all(60));
  const SilhouetteFit fit =
      compare_silhouettes(mask_of({0, 0, 11, 10}), mask_of({0, 0, 10, 10}), picture, plain(100));
  EXPECT_DOUBLE_EQ(fit.iou, 100.0 / 110);
  EXPECT_DOUBLE_EQ(fit.wrong_share, 0.10);
  EXPECT_DOUBLE_EQ(fit.shadow_share, 0.05);
}

TEST(CompareSilhouettes, OfTheSameIsPerfectAndOfNothingIsNothing) {
  const cv::Mat truth = mask_of({3, 3, 4, 4});
  EXPECT_DOUBLE_EQ(compare_silhouettes(truth, truth, plain(9), plain(9)).iou, 1);
  const SilhouetteFit none = compare_silhouettes({}, truth, plain(9), plain(9));
  EXPECT_DOUBLE_EQ(none.iou, 0);
  EXPECT_DOUBLE_EQ(none.wrong_share, 0);
}

TEST(CompareSilhouettes, RefusesOtherSizes) {
  const cv::Mat truth = mask_of({3, 3, 4, 4});
  EXPECT_THROW(static_cast<void>(compare_silhouettes(truth, truth, plain(9),
                                                     cv::Mat(10, 20, CV_8UC3, cv::Scalar::all(9)))),
               Error);
}

TEST(SilhouetteTable, CountsRefusedViewsAndShadows) {
  SilhouetteCase refused;
  refused.refused = true;
  const Table table = silhouette_table("set", {with_fit({0.9, 0.08, 0.06}), refused,
                                               with_fit({1, 0, 0}), with_fit({0.95, 0.04, 0.05})});
  EXPECT_THAT(table.rows, ElementsAre(ElementsAre("set", "4", "1", "0.925", "0.135", "0.000",
                                                  "3.00 %", "5.85 %", "6.00 %", "1")));
  EXPECT_THAT(silhouette_table("set", {}).rows, IsEmpty());
}

TEST(WorstSilhouettes, ComeFirstAndNoMoreThanAskedFor) {
  const auto worst =
      worst_silhouettes({with_fit({0.9, 0, 0}), with_fit({0.5, 0, 0}), with_fit({0.7, 0, 0})}, 2);
  ASSERT_EQ(worst.size(), 2U);
  EXPECT_DOUBLE_EQ(worst[0].fit.iou, 0.5);
  EXPECT_DOUBLE_EQ(worst[1].fit.iou, 0.7);
  EXPECT_THAT(worst_silhouettes({}, 2), IsEmpty());
}

}  // namespace
}  // namespace posevote
