// The binary labelling of least energy on the pixel grid.
#pragma once

#include <opencv2/core.hpp>

namespace posevote {

/// Edge weights to the neighbours of each pixel, CV_32F, >= 0; entries that lead out of the picture
/// are not read.
struct GridEdges {
  cv::Mat right, down, down_right, down_left;
};

/// Minimises  sum over pixels with label 1 of -log_odds  +  sum over neighbours of different label
/// of their edge weight  (Boykov & Jolly 2001). `log_odds`: CV_32F, log p(1) - log p(0). Only
/// pixels where `open` (CV_8U) is set are decided, the others keep their label of `given` (CV_8U,
/// non-zero: 1). Returns CV_8U 0/255.
[[nodiscard]] cv::Mat cut_grid(const cv::Mat& log_odds, const GridEdges& edges, const cv::Mat& open,
                               const cv::Mat& given);

}  // namespace posevote
