// SURF (Bay et al., CVIU 110(3), 2008) behind the Extractor interface.
#pragma once

#include <memory>

#include "posevote/feature/features.hpp"

namespace posevote {

/// `suits_size`: whether `double_below_px` and `more_in_large` count; otherwise pictures of all
/// sizes are treated alike.
[[nodiscard]] std::shared_ptr<const Extractor> make_surf_extractor(const FeatureOptions& options,
                                                                   bool suits_size = false);

}  // namespace posevote
