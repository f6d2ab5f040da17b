// Which of all candidates become key points.
#pragma once

#include <vector>

#include "posevote/feature/surf/hessian.hpp"

namespace posevote::surf {

struct Selection {
  int max_features = 0;  ///< 0: all
  bool spread = false;   ///< prefer the strongest of every part of the picture
  cv::Mat mask;          ///< empty or of the picture's size; see Extractor::extract
  cv::Size size;         ///< of the picture, px
};

/// The strongest candidates that can be refined and lie inside the mask; only about as many as are
/// asked for are refined. Sorted by `comes_before`. The order of `candidates` does not matter.
[[nodiscard]] std::vector<Keypoint> select(std::vector<const Candidate*> candidates,
                                           const Selection& selection, const Integral& integral);

}  // namespace posevote::surf
