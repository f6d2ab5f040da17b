// Evaluation as a gate: "recall=0.95,false_positives=0".
#pragma once

#include <string>
#include <vector>

#include "posevote/evaluate/summary.hpp"

namespace posevote {

struct Requirement {
  std::string name;
  double bound = 0;
};

/// Reads NAME=NUMBER pairs with commas between; "" gives none. Names: recall, precision (at least),
/// false_positives, false_positives_per_image, twins, median_ms, p95_ms (at most).
/// Throws Error{invalid_argument}.
[[nodiscard]] std::vector<Requirement> parse_requirements(const std::string& text);

/// One sentence for each requirement that `summary` does not meet. A number that does not exist
/// (e.g. the recall when nothing was asked) meets none.
[[nodiscard]] std::vector<std::string> unmet_requirements(
    const std::vector<Requirement>& requirements, const Summary& summary);

}  // namespace posevote
