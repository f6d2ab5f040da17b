// What every backend does with views besides its own queries.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "posevote/core/error.hpp"
#include "posevote/model/view.hpp"
#include "posevote/store/blob.hpp"
#include "posevote/store/taught_view.hpp"

namespace posevote {

/// The present time, UTC, ISO 8601 to the second.
[[nodiscard]] std::string utc_now();

/// Throws Error{code, "database 'LOCATION' REASON"}.
[[noreturn]] void throw_database_error(ErrorCode code, const std::string& location,
                                       const std::string& reason);

/// The view that `read` makes of a row. Throws Error{database_unusable} unless it is what was
/// stored with these hashes.
[[nodiscard]] View checked_view(const std::function<View()>& read, const std::string& identity,
                                const std::string& signature, const std::string& location);
/// The same of a view's picture and mask; `number` names the view.
void check_picture(const TaughtView& view, const std::string& identity, const std::string& number,
                   const std::string& location);

/// What an impostor is known by: its picture. Throws Error{invalid_argument} without one, and as
/// `check_features`.
[[nodiscard]] std::string identity_hash(const Impostor& impostor);

/// The object in small, encoded, from encoded pictures: kept beside the view, so that loading it
/// need not read them. Without a mask the outline's inside is the object. Empty when the picture
/// cannot be read.
[[nodiscard]] Blob patch_blob(const View& view, const Blob& picture, const Blob& mask);

/// Half floats for a snapshot, in half of the memory: their rounding, 2^-11 of a value, is far
/// below what two pictures of one point differ by.
void halve_descriptors(Features& features);

/// Encoded picture and mask of a view, fetched when they are needed.
using FetchPictures = std::function<std::pair<Blob, Blob>()>;

/// Sets `view.patch` from what is stored - views of older databases have none, for them it is made
/// again - and `view.picture` (8-bit BGR) and `view.mask` when they are asked for. Throws
/// Error{unreadable_image} for those, Error{database_unusable} for a damaged patch.
void add_pictures(View& view, BlobView stored_patch, bool pictures, const FetchPictures& fetch,
                  const std::string& location);

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
