// Features of things that were never there.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>

#include "posevote/feature/features.hpp"

namespace posevote::bench {

/// Another thing that looks similar: every descriptor moves by 0.5 in a random direction, farther
/// than those of one point in two pictures differ.
inline Features perturbed(const Features& features, cv::RNG& random) {
  Features result{features.keypoints, features.descriptors.clone()};
  for (int i = 0; i < result.descriptors.rows; ++i) {
    cv::Mat row = result.descriptors.row(i);
    cv::Mat noise(row.size(), row.type());
    random.fill(noise, cv::RNG::NORMAL, 0, 0.5 / std::sqrt(double(row.cols)));
    row += noise;
    cv::normalize(row, row);
  }
  return result;
}

}  // namespace posevote::bench
