#include "studio/settings.hpp"

#include <algorithm>
#include <array>
#include <fstream>

#include "posevote/core/error.hpp"
#include "studio/files.hpp"

namespace posevote::server {
namespace {

/// Worth showing to everybody, in this order.
constexpr std::array kBasic = {"recognize.verify.false_alarms_per_1000_images",
                               "recognize.unknown",
                               "live.recognize",
                               "live.max_fps",
                               "live.stream_width",
                               "live.stream_quality"};

bool is_basic(const std::string& name) {
  return std::ranges::find(kBasic, name) != kBasic.end();
}

std::string group_of(const std::string& name) {
  return name.substr(0, name.find('.'));
}

/// The features belong to the database, and recognition and teaching must agree on them.
bool is_fixed(const std::string& name) {
  return name.starts_with("recognize.feature.");
}

bool is_listed(const std::string& name) {
  return !name.starts_with("teach.feature.") && group_of(name) != "limits";
}

Json value_json(const OptionField& field) {
  return std::visit([](auto* value) { return Json(*value); }, field.value);
}

const char* type_of(const OptionField& field) {
  constexpr std::array names{"boolean", "integer", "number", "text"};
  return names[field.value.index()];
}

std::string text_of_value(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

Json field_json(const OptionField& field, const OptionField& base) {
  Json json{{"name", field.name},
            {"group", group_of(field.name)},
            {"level", is_basic(field.name) ? "basic" : "expert"},
            {"type", type_of(field)},
            {"value", value_json(field)},
            {"default", value_json(base)}};
  if (std::holds_alternative<int*>(field.value) || std::holds_alternative<double*>(field.value)) {
    json["min"] = field.min;
    json["max"] = field.max;
  }
  if (!field.choices.empty()) json["choices"] = field.choices;
  json["unit"] = field.unit;
  json["help"] = field.help;
  json["fixed"] = is_fixed(field.name);
  return json;
}

void apply(StudioOptions& options, StudioOptions base, const Json& changes) {
  const OptionList list = list_options(options), defaults = list_options(base);
  for (const auto& [name, value] : changes.items()) {
    if (is_fixed(name))
      throw Error(ErrorCode::invalid_argument,
                  "'" + name + "' is decided by the features of the database");
    if (!is_listed(name))
      throw Error(ErrorCode::invalid_argument, "'" + name + "' cannot be changed while it runs");
    if (!value.is_null()) {
      list.set(name, text_of_value(value));
      continue;
    }
    const auto field = std::ranges::find(defaults.fields(), name, &OptionField::name);
    list.set(name, field == defaults.fields().end() ? "" : field->text());
  }
  validate_options(options);
}

}  // namespace

void StudioOptions::describe(OptionList& list) {
  list.group("recognize", recognize);
  list.group("teach", teach);
  list.group("live", live);
  list.group("limits", limits);
}

Settings::Settings(StudioOptions base, std::string file)
    : base_(std::move(base)), file_(std::move(file)), options_(base_) {
  std::ifstream stream(file_);
  const Json kept = Json::parse(stream, nullptr, false);
  if (!kept.is_object()) return;
  for (const auto& [name, value] : kept.items()) {
    StudioOptions changed = options_;
    try {
      apply(changed, base_, {{name, value}});
      options_ = changed;
    } catch (const Error&) {
      continue;  // of another version
    }
  }
}

StudioOptions Settings::options() const {
  const std::lock_guard lock(mutex_);
  return options_;
}

int Settings::generation() const {
  const std::lock_guard lock(mutex_);
  return generation_;
}

Json Settings::json() const {
  StudioOptions now = options(), base = base_;
  const OptionList list = list_options(now), defaults = list_options(base);
  Json settings = Json::array();
  for (const char* basic : kBasic)
    for (std::size_t i = 0; i < list.fields().size(); ++i)
      if (list.fields()[i].name == basic)
        settings.push_back(field_json(list.fields()[i], defaults.fields()[i]));
  for (std::size_t i = 0; i < list.fields().size(); ++i) {
    const OptionField& field = list.fields()[i];
    if (is_listed(field.name) && !is_basic(field.name))
      settings.push_back(field_json(field, defaults.fields()[i]));
  }
  return {{"settings", std::move(settings)}};
}

void Settings::change(const Json& changes) {
  const std::lock_guard lock(mutex_);
  StudioOptions changed = options_;
  apply(changed, base_, changes);
  save(changed);
  options_ = changed;
  ++generation_;
}

void Settings::save(const StudioOptions& changed) const {
  StudioOptions now = changed, base = base_;
  const OptionList list = list_options(now), defaults = list_options(base);
  Json different = Json::object();
  for (std::size_t i = 0; i < list.fields().size(); ++i) {
    const OptionField& field = list.fields()[i];
    if (is_listed(field.name) && field.text() != defaults.fields()[i].text())
      different[field.name] = value_json(field);
  }
  write_file(file_, different.dump(2) + "\n");
}

}  // namespace posevote::server
