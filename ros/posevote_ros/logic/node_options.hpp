// Everything a node can be told, once for both ROSes: defaults, ranges and words stand here and in
// the library's own option structs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "logic/scene_watch.hpp"
#include "logic/tracks.hpp"
#include "posevote/core/options.hpp"
#include "posevote/recognize/recognizer.hpp"
#include "posevote/teach/teacher.hpp"

namespace posevote::logic {

/// Options by name, as text.
using Settings = std::map<std::string, std::string>;

struct NodeOptions {
  // Read once, at the start.
  std::string database;  ///< file or address; "": see `database_path`
  std::string preset = "default";
  std::string transport = "raw";  ///< of pictures: "raw" or "compressed"

  RecognizeOptions recognize;  ///< its fields stand at the top: vote.smooth, ...
  TeachOptions teach;          ///< teach.feature is always recognize.feature
  TrackOptions track;
  WatchOptions watch;
  std::string object_heights;    ///< see `parse_heights`
  bool rectified = false;        ///< pictures are free of distortion: use P of the camera_info
  double marker_distance_m = 1;  ///< of the outlines of objects whose height is not known
  bool publish_tf = false;
  std::string frame_prefix = "posevote/";
  double slow_ms = 1000;  ///< diagnostics warn when a result is older

  void describe(OptionList& list);
};

/// Options that a running node cannot take over.
[[nodiscard]] bool is_read_at_start(const std::string& option);

/// The database that `given` names: itself, else $POSEVOTE_DB, else posevote/objects.db in the XDG
/// data folder, as with the program `posevote`. Throws Error{io} when none of the variables is set.
[[nodiscard]] std::string database_path(const std::string& given);

/// The option names in ROS 1: '/' between the parts, as its parameter server has it
/// ("vote/smooth"), or "__" for dynamic_reconfigure, whose names are identifiers ("vote__smooth").
[[nodiscard]] std::string join_name(const std::string& option, const std::string& separator);

}  // namespace posevote::logic
