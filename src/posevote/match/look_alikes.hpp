// Which taught objects look alike: variants of one pack, or one thing taught under two names.
#pragma once

#include <vector>

#include "posevote/index/index.hpp"
#include "posevote/model/model_set.hpp"

namespace posevote {

/// The table of `Neighborhood`: element a * objects + b is 1 when a good part of the features of
/// one of the two objects is found on the other, much nearer than on any third. Looks at a sample
/// of each object's features; `index` holds `models`. Symmetric.
[[nodiscard]] std::vector<char> find_look_alikes(const ModelSet& models, const Index& index);

}  // namespace posevote
