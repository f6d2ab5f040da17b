// What is there besides the known objects?
#pragma once

#include <vector>

#include "posevote/recognize/recognizer.hpp"

namespace posevote {

/// Textured parts of the picture that no detection explains: connected areas in which key points
/// lie densely, at least 1 % of the picture each, most features first. A textured table is one as
/// well: nothing tells it from a thing that was not taught.
[[nodiscard]] std::vector<UnknownRegion> find_unknown(const Features& scene, cv::Size size,
                                                      const std::vector<Detection>& detections);

}  // namespace posevote
