// Which features of a view are found again from elsewhere?
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "posevote/feature/features.hpp"

namespace posevote {

/// The features of a copy of a picture whose sides are `fx` and `fy` times as long.
struct ShortenedFeatures {
  Features features;
  double fx = 1, fy = 1;
};

[[nodiscard]] ShortenedFeatures extract_shortened(const cv::Mat& picture, const cv::Mat& mask,
                                                  double fx, double fy, const Extractor& extractor);

/// For each of `features` the distance to its likeness in the shortened copy: to the most similar
/// feature there when that is the one at its place, of its size and sign, else infinity.
[[nodiscard]] std::vector<float> find_likenesses(const Features& features,
                                                 const ShortenedFeatures& shortened);

/// For each of `features` (of `picture` inside `mask`, as `extractor` gave them) whether it
/// repeats: 1 when in a simulated picture - the object turned away by 45 degrees about its vertical
/// or its horizontal axis, or 1.4 times farther off - the most similar feature is the one at its
/// place, else 0. Takes three feature extractions.
[[nodiscard]] std::vector<char> find_repeatable(const cv::Mat& picture, const cv::Mat& mask,
                                                const Features& features,
                                                const Extractor& extractor);

}  // namespace posevote
