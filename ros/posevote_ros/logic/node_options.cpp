#include "logic/node_options.hpp"

#include <cstdlib>
#include <filesystem>

#include "posevote/core/error.hpp"

namespace posevote::logic {
namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

void add_field(OptionList& list, const std::string& name, const OptionField& field) {
  if (auto* const* flag = std::get_if<bool*>(&field.value))
    list.add(name, **flag, field.help);
  else if (auto* const* whole = std::get_if<int*>(&field.value))
    list.add(name, **whole, {field.min, field.max}, field.unit, field.help);
  else if (auto* const* real = std::get_if<double*>(&field.value))
    list.add(name, **real, {field.min, field.max}, field.unit, field.help);
  else
    list.add(name, *std::get<std::string*>(field.value), field.choices, field.help);
}

}  // namespace

void NodeOptions::describe(OptionList& list) {
  list.add("database", database, {},
           "File that holds the objects, or postgresql:// address; empty: $POSEVOTE_DB, else "
           "posevote/objects.db in the XDG "
           "data folder.");
  list.add("preset", preset, preset_names(), "Recognition options to begin with.");
  list.add("transport", transport, {"raw", "compressed"}, "How pictures come from the camera.");
  list.add("object_heights", object_heights, {},
           "Heights of objects in metres, as NAME=HEIGHT; NAME=HEIGHT; these get poses.");
  list.add("rectified", rectified, "The pictures are rectified: no distortion, matrix P.");
  list.add("marker_distance_m", marker_distance_m, {0.01, 1000}, "m",
           "Distance at which outlines of objects without a height are drawn.");
  list.add("publish_tf", publish_tf, "Send a tf frame for every confirmed object with a pose.");
  list.add("frame_prefix", frame_prefix, {}, "Stands before the names of tf frames.");
  list.add("slow_ms", slow_ms, {1, 1e6}, "ms", "Diagnostics warn when results are older.");
  list.group("track", track);
  list.group("watch", watch);
  recognize.describe(list);
  const OptionList teaching = list_options(teach);
  for (const OptionField& field : teaching.fields())
    if (field.name.rfind("feature.", 0) != 0) add_field(list, "teach." + field.name, field);
}

bool is_read_at_start(const std::string& option) {
  return option == "database" || option == "preset" || option == "transport";
}

std::string database_path(const std::string& given) {
  if (!given.empty()) return given;
  std::string named = environment("POSEVOTE_DB");
  if (!named.empty()) return named;
  const std::string xdg = environment("XDG_DATA_HOME"), home = environment("HOME");
  if (xdg.empty() && home.empty())
    throw Error(ErrorCode::io,
                "there is no home folder to keep objects in; set the parameter 'database'");
  const std::filesystem::path data =
      xdg.empty() ? std::filesystem::path(home) / ".local" / "share" : std::filesystem::path(xdg);
  return (data / "posevote" / "objects.db").string();
}

std::string join_name(const std::string& option, const std::string& separator) {
  std::string joined;
  for (const char c : option) joined += c == '.' ? separator : std::string(1, c);
  return joined;
}

}  // namespace posevote::logic
