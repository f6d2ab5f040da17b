// What every backend does with views besides its own queries.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "posevote/model/view.hpp"
#include "posevote/store/taught_view.hpp"

namespace posevote {

/// The present time, UTC, ISO 8601 to the second.
[[nodiscard]] std::string utc_now();

/// Sets `view.picture` (8-bit BGR) and `view.mask` from their encoded forms; `name` stands for them
/// in messages. Throws Error{unreadable_image}.
void decode_pictures(View& view, const std::vector<std::uint8_t>& picture,
                     const std::vector<std::uint8_t>& mask, const std::string& name);

/// The object in small, from encoded pictures; without a mask the outline's inside is the object.
/// Empty when the picture cannot be read.
[[nodiscard]] Patch patch_of(const View& view, const std::vector<std::uint8_t>& picture,
                             const std::vector<std::uint8_t>& mask);

/// Views that a snapshot, still alive, holds. For one thread at a time.
class ViewCache {
 public:
  /// The view of that key (its content's hash and id), or else what `make` gives.
  [[nodiscard]] std::shared_ptr<const View> get(
      const std::string& key, const std::function<std::shared_ptr<const View>()>& make);
  /// Forgets the views that are gone.
  void tidy();

 private:
  std::map<std::string, std::weak_ptr<const View>> views_;
};

}  // namespace posevote
