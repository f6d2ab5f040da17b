#include "posevote/teach/graph_cut.hpp"

#include <algorithm>
#include <vector>

#include <opencv2/imgproc/detail/gcgraph.hpp>

namespace posevote {

cv::Mat cut_grid(const cv::Mat& log_odds, const GridEdges& edges, const cv::Mat& open,
                 const cv::Mat& given) {
  cv::Mat node(log_odds.size(), CV_32S, cv::Scalar(-1));
  const int count = cv::countNonZero(open);
  cv::Mat labels = given != 0;
  if (count == 0) return labels;
  cv::detail::GCGraph<float> graph(static_cast<unsigned>(count), static_cast<unsigned>(8 * count));
  for (int y = 0; y < open.rows; ++y) {
    for (int x = 0; x < open.cols; ++x) {
      if (!open.at<uchar>(y, x)) continue;
      const int id = graph.addVtx();
      node.at<int>(y, x) = id;
      const float odds = log_odds.at<float>(y, x);
      graph.addTermWeights(id, std::max(odds, 0.F), std::max(-odds, 0.F));
    }
  }
  // An edge to a closed pixel is a cost of the other label.
  const auto link = [&](cv::Point a, cv::Point b, const cv::Mat& weights, cv::Point owner) {
    const int i = node.at<int>(a);
    if (b.x < 0 || b.x >= open.cols || b.y >= open.rows) return;
    const int j = node.at<int>(b);
    if (i < 0 && j < 0) return;
    const float w = weights.at<float>(owner);
    if (i >= 0 && j >= 0) {
      graph.addEdges(i, j, w, w);
      return;
    }
    const bool object = labels.at<uchar>(i >= 0 ? b : a) != 0;
    graph.addTermWeights(i >= 0 ? i : j, object ? w : 0, object ? 0 : w);
  };
  for (int y = 0; y < open.rows; ++y) {
    for (int x = 0; x < open.cols; ++x) {
      const cv::Point p(x, y);
      link(p, {x + 1, y}, edges.right, p);
      link(p, {x, y + 1}, edges.down, p);
      link(p, {x + 1, y + 1}, edges.down_right, p);
      link(p, {x - 1, y + 1}, edges.down_left, p);
    }
  }
  // The solver wants an edge, be it one between two pixels that are not there.
  const int first = graph.addVtx(), second = graph.addVtx();
  graph.addEdges(first, second, 0, 0);
  graph.maxFlow();
  for (int y = 0; y < open.rows; ++y) {
    for (int x = 0; x < open.cols; ++x) {
      const int id = node.at<int>(y, x);
      if (id >= 0) labels.at<uchar>(y, x) = graph.inSourceSegment(id) ? 255 : 0;
    }
  }
  return labels;
}

}  // namespace posevote
