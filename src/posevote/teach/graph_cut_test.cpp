#include "posevote/teach/graph_cut.hpp"

#include <gtest/gtest.h>

namespace posevote {
namespace {

struct Problem {
  cv::Mat log_odds;
  GridEdges edges;
};

Problem random_problem(cv::Size size, int seed) {
  cv::RNG random(static_cast<uint64>(seed));
  const auto filled = [&](double low, double high) {
    cv::Mat m(size, CV_32F);
    random.fill(m, cv::RNG::UNIFORM, low, high);
    return m;
  };
  Problem p;
  p.log_odds = filled(-2, 2);
  p.edges = {filled(0, 1.5), filled(0, 1.5), filled(0, 1.5), filled(0, 1.5)};
  return p;
}

double energy(const Problem& p, const cv::Mat& labels) {
  double sum = 0;
  const auto side = [&](int y, int x, int y2, int x2, const cv::Mat& weight) {
    if (x2 < 0 || x2 >= labels.cols || y2 >= labels.rows) return;
    if ((labels.at<uchar>(y, x) != 0) != (labels.at<uchar>(y2, x2) != 0)) {
      sum += weight.at<float>(y, x);
    }
  };
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      if (labels.at<uchar>(y, x)) sum -= p.log_odds.at<float>(y, x);
      side(y, x, y, x + 1, p.edges.right);
      side(y, x, y + 1, x, p.edges.down);
      side(y, x, y + 1, x + 1, p.edges.down_right);
      side(y, x, y + 1, x - 1, p.edges.down_left);
    }
  }
  return sum;
}

// The least energy of all labellings that agree with `given` outside `open`.
double least_energy(const Problem& p, const cv::Mat& open, const cv::Mat& given) {
  double least = 1e9;
  const int pixels = static_cast<int>(open.total());
  for (int code = 0; code < 1 << pixels; ++code) {
    cv::Mat labels(open.size(), CV_8U);
    bool agrees = true;
    for (int i = 0; i < pixels; ++i) {
      labels.data[i] = (code >> i & 1) ? 255 : 0;
      agrees &= open.data[i] != 0 || labels.data[i] == given.data[i];
    }
    if (agrees) least = std::min(least, energy(p, labels));
  }
  return least;
}

class CutGrid : public ::testing::TestWithParam<int> {};

TEST_P(CutGrid, FindsTheLeastOfAllLabellings) {
  const cv::Size size(4, 3);
  const Problem p = random_problem(size, GetParam());
  const cv::Mat open(size, CV_8U, cv::Scalar(255)), given = cv::Mat::zeros(size, CV_8U);
  const cv::Mat labels = cut_grid(p.log_odds, p.edges, open, given);
  EXPECT_NEAR(energy(p, labels), least_energy(p, open, given), 1e-4);
}

TEST_P(CutGrid, KeepsTheLabelsOfClosedPixels) {
  const cv::Size size(4, 3);
  const Problem p = random_problem(size, GetParam());
  cv::Mat open(size, CV_8U, cv::Scalar(255)), given = cv::Mat::zeros(size, CV_8U);
  open.col(0) = 0;
  open.at<uchar>(1, 3) = 0;
  given.at<uchar>(1, 0) = 255;
  given.at<uchar>(1, 3) = 255;
  const cv::Mat labels = cut_grid(p.log_odds, p.edges, open, given);
  EXPECT_EQ(labels.at<uchar>(0, 0), 0);
  EXPECT_EQ(labels.at<uchar>(1, 0), 255);
  EXPECT_EQ(labels.at<uchar>(1, 3), 255);
  EXPECT_NEAR(energy(p, labels), least_energy(p, open, given), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Seeds, CutGrid, ::testing::Range(1, 9));

TEST(CutGridAlone, FollowsTheOddsWithoutEdges) {
  Problem p = random_problem({5, 4}, 3);
  for (cv::Mat* m : {&p.edges.right, &p.edges.down, &p.edges.down_right, &p.edges.down_left}) {
    m->setTo(0);
  }
  const cv::Mat labels = cut_grid(p.log_odds, p.edges, cv::Mat(4, 5, CV_8U, cv::Scalar(1)),
                                  cv::Mat::zeros(4, 5, CV_8U));
  EXPECT_EQ(cv::norm(labels, p.log_odds > 0, cv::NORM_INF), 0);
}

TEST(CutGridAlone, DecidesNothingWhenNothingIsOpen) {
  const Problem p = random_problem({5, 4}, 3);
  const cv::Mat given(4, 5, CV_8U, cv::Scalar(7));
  const cv::Mat labels = cut_grid(p.log_odds, p.edges, cv::Mat::zeros(4, 5, CV_8U), given);
  EXPECT_EQ(cv::countNonZero(labels == 255), 20);
}

TEST(CutGridAlone, DecidesOnePixel) {
  const Problem p = random_problem({1, 1}, 3);
  const cv::Mat labels = cut_grid(p.log_odds, p.edges, cv::Mat(1, 1, CV_8U, cv::Scalar(1)),
                                  cv::Mat::zeros(1, 1, CV_8U));
  EXPECT_EQ(labels.at<uchar>(0, 0) != 0, p.log_odds.at<float>(0, 0) > 0);
}

}  // namespace
}  // namespace posevote
