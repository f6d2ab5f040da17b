// Objects from one database to another, and as one portable file.
#pragma once

#include <string>
#include <vector>

#include "posevote/store/object_store.hpp"

namespace posevote {

/// What to do with an object whose name is taken.
enum class OnConflict {
  refuse,   ///< throw Error{already_exists}, nothing is changed
  replace,  ///< its views are removed first
  merge,    ///< its views are kept, those that are not there yet are added
};

struct TransferResult {
  int objects = 0;  ///< objects copied
  int views_added = 0;
  int views_known = 0;  ///< were there already
};

/// Copies `names` (none: all objects) as one change of `to`. Throws Error{not_found} for a name
/// that `from` does not have, Error{feature_mismatch} when the two hold different features.
TransferResult copy_objects(const ObjectStore& from, ObjectStore& to,
                            const std::vector<std::string>& names, OnConflict on_conflict);

/// Writes `names` (none: all objects) into the new file `path`: a database that any posevote opens.
/// It appears complete or not at all. Throws Error{already_exists} when the file exists and
/// `overwrite` is not set.
TransferResult export_objects(const ObjectStore& from, const std::string& path,
                              const std::vector<std::string>& names, bool overwrite = false);

/// Writes all objects and impostors into the new file `path`, as `export_objects` does; an empty
/// database gives an empty one. Throws Error{already_exists} when the file exists.
TransferResult save_copy(const ObjectStore& from, const std::string& path);

/// The reverse of `export_objects`; the file is not changed.
TransferResult import_objects(const std::string& path, ObjectStore& to,
                              const std::vector<std::string>& names, OnConflict on_conflict);

}  // namespace posevote
