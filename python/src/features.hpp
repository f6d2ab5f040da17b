// Features as Python sees them.
#pragma once

#include "convert.hpp"
#include "posevote/feature/features.hpp"

namespace posevote::python {

/// Shares what `owner` keeps alive.
[[nodiscard]] inline std::shared_ptr<Features> share(const std::shared_ptr<const void>& owner,
                                                     const Features& features) {
  return {std::const_pointer_cast<void>(owner), const_cast<Features*>(&features)};
}

}  // namespace posevote::python
