// A picture of what became of one object: its matches, its votes, its strongest pose.
#pragma once

#include <opencv2/core.hpp>

#include "posevote/recognize/explain.hpp"

namespace posevote {

/// Two pictures side by side, BGR 8-bit, each as large as `image`: left the scene with the features
/// that match the object and the outline of its strongest pose (green when it was found, else
/// orange); right the accumulator, brighter where more votes put the object's centre.
[[nodiscard]] cv::Mat draw_explanation(const cv::Mat& image, const Explanation& explanation);

}  // namespace posevote
