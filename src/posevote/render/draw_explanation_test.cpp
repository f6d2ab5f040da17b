#include "posevote/render/draw_explanation.hpp"

#include <gtest/gtest.h>

namespace posevote {
namespace {

const cv::Mat kScene(120, 160, CV_8UC3, cv::Scalar::all(90));

TEST(DrawExplanation, ShowsSceneAndAccumulatorSideBySide) {
  const cv::Mat drawn = draw_explanation(kScene, {});
  EXPECT_EQ(drawn.size(), cv::Size(320, 120));
  EXPECT_EQ(drawn.type(), CV_8UC3);
}

TEST(DrawExplanation, IsBrightestWhereTheVotesMeet) {
  Explanation explanation;
  explanation.vote_centres = {{40, 60}, {41, 60}, {40, 61}, {130, 20}, {-9, 500}};
  const cv::Mat heat = draw_explanation(kScene, explanation).colRange(160, 320);
  const auto brightness = [&](int x, int y) { return cv::sum(heat.at<cv::Vec3b>(y, x))[0]; };
  EXPECT_GT(brightness(40, 60), brightness(130, 20));
  EXPECT_GT(brightness(130, 20), brightness(90, 100));
}

TEST(DrawExplanation, MarksMatchesAndTheOutlineAndBearsOnesFarOutside) {
  Explanation explanation;
  explanation.matches = {{{0, 0}, {30, 30}}};
  explanation.best = Detection();
  explanation.best->outline = {{80, 40}, {120, 40}, {120, 90}, {1e30F, -1e30F}};
  const cv::Mat plain = draw_explanation(kScene, {}), drawn = draw_explanation(kScene, explanation);
  EXPECT_NE(cv::norm(plain(cv::Rect(20, 20, 20, 20)), drawn(cv::Rect(20, 20, 20, 20))), 0);
  EXPECT_NE(drawn.at<cv::Vec3b>(40, 100), plain.at<cv::Vec3b>(40, 100));
}

TEST(DrawExplanation, TakesGreyAndDeepPictures) {
  for (const int type : {CV_8U, CV_16U, CV_8UC4, CV_16UC3})
    EXPECT_EQ(draw_explanation(cv::Mat(50, 60, type, cv::Scalar::all(9)), {}).size(),
              cv::Size(120, 50));
}

}  // namespace
}  // namespace posevote
