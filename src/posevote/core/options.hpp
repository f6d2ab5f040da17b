// Options that describe themselves: defaults, ranges, units and help live in the option structs
// alone; command line, server, Python, ROS and docs read them from here.
//
// An option struct is plain data with a member `void describe(OptionList& list)` that names its
// fields:
//
//   void SurfOptions::describe(OptionList& list) {
//     list.add("octaves", octaves, {1, 8}, "", "Number of octaves of the scale space.");
//   }
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace posevote {

/// One field of an option struct, by reference: valid as long as the struct lives.
struct OptionField {
  std::string name;  ///< dotted path, snake_case, e.g. "surf.octaves"
  std::variant<bool*, int*, double*, std::string*> value;
  double min = 0, max = 0;           ///< closed range of numbers
  std::string unit;                  ///< "px", "deg", "ms" or ""
  std::string help;                  ///< one sentence
  std::vector<std::string> choices;  ///< allowed strings; empty: any

  [[nodiscard]] std::string text() const;  ///< the present value, as `OptionList::set` reads it
};

struct OptionRange {
  double min, max;
};

/// The fields of an option struct and of those nested in it.
class OptionList {
 public:
  void add(const std::string& name, bool& value, const std::string& help);
  void add(const std::string& name, int& value, OptionRange range, const std::string& unit,
           const std::string& help);
  void add(const std::string& name, double& value, OptionRange range, const std::string& unit,
           const std::string& help);
  void add(const std::string& name, std::string& value, const std::vector<std::string>& choices,
           const std::string& help);
  /// Fields of a nested option struct; their names get "name." in front.
  template <class Options>
  void group(const std::string& name, Options& nested) {
    const std::string outer = prefix_;
    prefix_ += name + ".";
    nested.describe(*this);
    prefix_ = outer;
  }

  [[nodiscard]] const std::vector<OptionField>& fields() const noexcept { return fields_; }

  /// Sets one field from text. Throws Error{invalid_argument}: unknown name (with the nearest one),
  /// not a number, out of range, not one of the choices.
  void set(const std::string& name, const std::string& text) const;

  /// Throws Error{invalid_argument} that names the first field outside its range or choices.
  void validate() const;

 private:
  std::string prefix_;
  std::vector<OptionField> fields_;
};

/// All fields of `options`, which must outlive the list.
template <class Options>
[[nodiscard]] OptionList list_options(Options& options) {
  OptionList list;
  options.describe(list);
  return list;
}

/// Checks every field of `options` against its range; throws Error{invalid_argument}.
template <class Options>
void validate_options(Options options) {
  list_options(options).validate();
}

/// The candidate with the smallest edit distance to `word`, or "" when none is near (distance more
/// than a third of the longer word, at least 2).
[[nodiscard]] std::string nearest_word(const std::string& word,
                                       const std::vector<std::string>& candidates);

}  // namespace posevote
