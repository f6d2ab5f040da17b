// SURF (Bay et al., CVIU 110(3), 2008) behind the Extractor interface.
#pragma once

#include <memory>

#include "posevote/feature/features.hpp"

namespace posevote {

[[nodiscard]] std::shared_ptr<const Extractor> make_surf_extractor(const FeatureOptions& options);

}  // namespace posevote
