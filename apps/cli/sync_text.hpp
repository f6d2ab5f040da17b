// Views and conflicts of two databases, as text and JSON.
#pragma once

#include <string>
#include <vector>

#include "posevote/json/recognition_json.hpp"
#include "posevote/store/sync.hpp"

namespace posevote::cli {

/// One line each: "WHAT  OBJECT, view from SOURCE, taught TIME by VERSION".
void print_views(const std::string& what, const std::vector<KnownView>& views);

/// {"object", "view", "source", "taught_at", "version", "identity", "hash"} of each.
[[nodiscard]] Json views_json(const std::vector<KnownView>& views);

void print_conflicts(const std::vector<Conflict>& conflicts);
/// {"kind", "object", "other_object", "identity", "text"} of each.
[[nodiscard]] Json conflicts_json(const std::vector<Conflict>& conflicts);

}  // namespace posevote::cli
