// Which objects that are known already answer to the views of a new one?
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posevote/recognize/recognizer.hpp"

namespace posevote {

struct Resemblance {
  std::string object;
  int features = 0;  ///< most that agreed on one pose in one of the views
};

/// Other objects than `name` of which a part is found on one of `views`, by more than chance, most
/// features first. `views` with pictures. Throws what the Recognizer throws.
[[nodiscard]] std::vector<Resemblance> find_resemblances(
    const std::string& name, const std::vector<std::shared_ptr<const View>>& views,
    const ModelSet& models, const FeatureOptions& features);

}  // namespace posevote
