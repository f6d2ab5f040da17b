#include "posevote/evaluate/requirement.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "posevote/core/error.hpp"
#include "posevote/core/options.hpp"
#include "posevote/evaluate/table.hpp"

namespace posevote {
namespace {

struct Quantity {
  const char* name;
  bool at_least;
  double (*value)(const Summary&);
};

const Quantity quantities[] = {
    {"recall", true, [](const Summary& s) { return s.recall(); }},
    {"precision", true, [](const Summary& s) { return s.precision(); }},
    {"false_positives", false, [](const Summary& s) { return double(s.false_positives); }},
    {"false_positives_per_image", false,
     [](const Summary& s) { return s.false_positives_per_image(); }},
    {"twins", false, [](const Summary& s) { return double(s.twins); }},
    {"median_ms", false, [](const Summary& s) { return s.total.median_ms; }},
    {"p95_ms", false, [](const Summary& s) { return s.total.p95_ms; }}};

const Quantity* find_quantity(const std::string& name) {
  const auto* found =
      std::ranges::find_if(quantities, [&](const Quantity& q) { return name == q.name; });
  return found == std::end(quantities) ? nullptr : found;
}

Requirement parse_one(const std::string& text) {
  const auto fail = [](const std::string& message) {
    throw Error(ErrorCode::invalid_argument, message);
  };
  const auto equals = text.find('=');
  if (equals == std::string::npos) fail("a requirement is NAME=NUMBER, not '" + text + "'");
  Requirement requirement{text.substr(0, equals), 0};
  if (find_quantity(requirement.name) == nullptr) {
    std::vector<std::string> names;
    for (const Quantity& quantity : quantities) names.emplace_back(quantity.name);
    const std::string nearest = nearest_word(requirement.name, names);
    fail("nothing called '" + requirement.name + "' can be required" +
         (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
  }
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + equals + 1, end, requirement.bound);
  if (error != std::errc() || stop != end)
    fail("requirement " + requirement.name + " needs a number, not '" + text.substr(equals + 1) +
         "'");
  return requirement;
}

}  // namespace

std::vector<Requirement> parse_requirements(const std::string& text) {
  std::vector<Requirement> requirements;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) requirements.push_back(parse_one(part));
  return requirements;
}

std::vector<std::string> unmet_requirements(const std::vector<Requirement>& requirements,
                                            const Summary& summary) {
  std::vector<std::string> failures;
  for (const Requirement& requirement : requirements) {
    const Quantity& quantity = *find_quantity(requirement.name);
    const double value = quantity.value(summary);
    if (quantity.at_least ? value >= requirement.bound : value <= requirement.bound) continue;
    failures.push_back(summary.name + ": " + requirement.name + " is " + fixed(value, 4) +
                       ", required is at " + (quantity.at_least ? "least " : "most ") +
                       fixed(requirement.bound, 4));
  }
  return failures;
}

}  // namespace posevote
