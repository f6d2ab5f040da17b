// What a database knows of its objects and views, as JSON.
#pragma once

#include "posevote/json/recognition_json.hpp"
#include "posevote/store/object_store.hpp"

namespace posevote {

/// null for NaN and infinities.
[[nodiscard]] Json number_or_null(double value);

/// {"object", "views", "features", "first_taught_at", "last_taught_at"}.
[[nodiscard]] Json object_json(const ObjectSummary& object);

/// {"view", "yaw", "width", "height", "features", "coverage", "method", "source", "taught_at",
/// "version", "hash"}.
[[nodiscard]] Json view_json(const ViewSummary& view);

}  // namespace posevote
