// Looking for some of the objects only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posevote/model/model_set.hpp"

namespace posevote::logic {

/// The objects of these names, sharing their views, and all impostors; no names: `all` itself.
/// Names that `all` does not have are passed over: objects come and go while the names stay.
[[nodiscard]] std::shared_ptr<const ModelSet> select_objects(std::shared_ptr<const ModelSet> all,
                                                             const std::vector<std::string>& names);

}  // namespace posevote::logic
