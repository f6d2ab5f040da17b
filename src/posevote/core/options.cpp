#include "posevote/core/options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

[[noreturn]] void fail(const std::string& message) {
  throw Error(ErrorCode::invalid_argument, message);
}

std::string number_text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return {buffer, end};
}

template <class Number>
Number parse_number(const OptionField& field, const std::string& text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end)
    fail("option " + field.name + " needs a " +
         (std::is_integral_v<Number> ? "whole number" : "number") + ", not '" + text + "'");
  return value;
}

bool parse_bool(const OptionField& field, const std::string& text) {
  if (text == "true" || text == "1" || text == "on" || text == "yes") return true;
  if (text == "false" || text == "0" || text == "off" || text == "no") return false;
  fail("option " + field.name + " is either true or false, not '" + text + "'");
}

void check_range(const OptionField& field, double value) {
  if (!(value >= field.min && value <= field.max))
    fail("option " + field.name + " must lie between " + number_text(field.min) + " and " +
         number_text(field.max) + (field.unit.empty() ? "" : " " + field.unit) + ", not " +
         number_text(value));
}

void check_choice(const OptionField& field, const std::string& value) {
  if (field.choices.empty() || std::ranges::count(field.choices, value)) return;
  std::string list;
  for (const auto& choice : field.choices) list += (list.empty() ? "" : ", ") + choice;
  fail("option " + field.name + " must be one of " + list + ", not '" + value + "'");
}

void check(const OptionField& field) {
  if (auto* const* number = std::get_if<int*>(&field.value)) check_range(field, **number);
  if (auto* const* number = std::get_if<double*>(&field.value)) check_range(field, **number);
  if (auto* const* word = std::get_if<std::string*>(&field.value)) check_choice(field, **word);
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
    }
  }
  return row.back();
}

}  // namespace

std::string OptionField::text() const {
  if (auto* const* flag = std::get_if<bool*>(&value)) return **flag ? "true" : "false";
  if (auto* const* number = std::get_if<int*>(&value)) return std::to_string(**number);
  if (auto* const* number = std::get_if<double*>(&value)) return number_text(**number);
  return *std::get<std::string*>(value);
}

void OptionList::add(const std::string& name, bool& value, const std::string& help) {
  fields_.push_back({prefix_ + name, &value, 0, 1, "", help, {}});
}

void OptionList::add(const std::string& name, int& value, OptionRange range,
                     const std::string& unit, const std::string& help) {
  fields_.push_back({prefix_ + name, &value, range.min, range.max, unit, help, {}});
}

void OptionList::add(const std::string& name, double& value, OptionRange range,
                     const std::string& unit, const std::string& help) {
  fields_.push_back({prefix_ + name, &value, range.min, range.max, unit, help, {}});
}

void OptionList::add(const std::string& name, std::string& value,
                     const std::vector<std::string>& choices, const std::string& help) {
  fields_.push_back({prefix_ + name, &value, 0, 0, "", help, choices});
}

void OptionList::set(const std::string& name, const std::string& text) const {
  const auto found = std::ranges::find(fields_, name, &OptionField::name);
  if (found == fields_.end()) {
    std::vector<std::string> names;
    for (const auto& field : fields_) names.push_back(field.name);
    const std::string nearest = nearest_word(name, names);
    fail("there is no option '" + name + "'" +
         (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
  }
  if (auto* const* flag = std::get_if<bool*>(&found->value)) {
    **flag = parse_bool(*found, text);
  } else if (auto* const* whole = std::get_if<int*>(&found->value)) {
    const int value = parse_number<int>(*found, text);
    check_range(*found, value);
    **whole = value;
  } else if (auto* const* real = std::get_if<double*>(&found->value)) {
    const double value = parse_number<double>(*found, text);
    check_range(*found, value);
    **real = value;
  } else {
    check_choice(*found, text);
    *std::get<std::string*>(found->value) = text;
  }
}

void OptionList::validate() const {
  for (const auto& field : fields_) check(field);
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = static_cast<std::size_t>(-1);
  for (const auto& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    const std::size_t limit = std::max<std::size_t>(2, std::max(word.size(), candidate.size()) / 3);
    if (distance <= limit && distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

}  // namespace posevote
