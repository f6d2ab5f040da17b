// What making a recogniser ready finds out, as bytes: the next one need not find it out again.
#pragma once

#include <string>

#include "posevote/index/index.hpp"
#include "posevote/match/look_alikes.hpp"

namespace posevote {

struct Prepared {
  std::string index;       ///< for `load_index`
  LookAlikes look_alikes;  ///< among the objects that are as they were; no models: nothing is known
};

/// Objects are known again by the hashes of their views; those without hashes are left out.
[[nodiscard]] std::string save_prepared(const Index& index, const LookAlikes& look_alikes);

/// `bytes` may be of an older or newer state of `models`. Damaged ones are as good as none.
[[nodiscard]] Prepared read_prepared(const std::string& bytes, const ModelSet& models);

}  // namespace posevote
