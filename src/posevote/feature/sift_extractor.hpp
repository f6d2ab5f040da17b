// OpenCV's SIFT behind the Extractor interface.
#pragma once

#include <memory>

#include "posevote/feature/features.hpp"

namespace posevote {

/// Rows are RootSIFT (Arandjelovic and Zisserman 2012): divided by their sum, square root taken, so
/// that the Euclidean distance is the Hellinger distance of the histograms. A point with several
/// orientations gives several features.
[[nodiscard]] std::shared_ptr<const Extractor> make_sift_extractor(const FeatureOptions& options);

}  // namespace posevote
