// The node itself, without ROS: a database, a recogniser that follows it, tracks and poses.
#pragma once

#include <memory>
#include <mutex>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "logic/node_options.hpp"
#include "logic/pose.hpp"
#include "logic/relief.hpp"
#include "logic/teach_session.hpp"
#include "logic/tracks.hpp"
#include "posevote/recognize/recognizer.hpp"
#include "posevote/store/follower.hpp"
#include "posevote/store/transfer.hpp"

namespace posevote::logic {

struct FoundObject {
  Detection detection;
  Track track;        ///< id 0: not tracked
  std::string frame;  ///< tf frame; "" when not tracked
  std::optional<ObjectPose> pose;
  std::vector<cv::Vec3d> outline;  ///< to be drawn, metres in the camera's optical frame; empty
                                   ///< when the camera is not calibrated
};

struct Findings {
  RecognitionResult result;
  std::vector<FoundObject> objects;  ///< one for each of result.detections
  std::string problem;               ///< why there are no poses although there should be; "": none
};

/// What is known of the database; as of the last time that it could be reached.
struct DatabaseState {
  std::string location;
  std::int64_t version = 0;
  std::string features;  ///< kind, "" while nothing was taught
  bool read_only = false;
  std::vector<ObjectSummary> objects;
  std::vector<std::string> active;  ///< empty: all
  std::string problem;              ///< why it cannot be followed at present; "": it is
  [[nodiscard]] bool is_active(const std::string& object) const;
  /// Its place in `objects`, from 0; -1: it is not there.
  [[nodiscard]] int place_of(const std::string& object) const;
};

/// Safe to call from many threads: teaching and services may change the database while another
/// thread recognises. Changes that other programs make to the database are followed in a thread of
/// its own; while the database cannot be reached, recognition goes on with what is known. What is
/// changed here is seen with the next picture. Members that change the database, or read more of
/// it than its state, throw Error as the store does.
class ObjectRecognition {
 public:
  /// Opens or makes the database. `settings`: options that differ from the defaults; those of the
  /// features default to the ones that the database was made with. Throws Error{invalid_argument}
  /// for an unknown option or a value out of range, Error{feature_mismatch} for features that the
  /// database does not hold, and as `open_store` does.
  explicit ObjectRecognition(const Settings& settings);

  /// Recognises in the camera's next picture; instances are followed from one call to the next.
  [[nodiscard]] Findings recognize(const cv::Mat& picture, const std::optional<Camera>& camera);

  /// The same in a picture that has nothing to do with the others: no tracks.
  [[nodiscard]] Findings recognize_once(const cv::Mat& picture,
                                        const std::optional<Camera>& camera);

  [[nodiscard]] NodeOptions options() const;

  /// Changes options while running. All or nothing. Throws as the constructor, and
  /// Error{invalid_argument} for options that are read at the start.
  void set(const Settings& settings);

  [[nodiscard]] DatabaseState database() const;
  /// Whether the database, or what is looked for, is not what it was at the last call.
  [[nodiscard]] bool changed();

  /// Throws Error{not_found} for names that are not there. Empty: all.
  void set_active(const std::vector<std::string>& names);

  /// Removes one view, or with view "" the whole object.
  void remove(const std::string& object, const std::string& view);
  /// The object stays active if it was.
  void rename(const std::string& from, const std::string& to);
  /// Copies all objects and impostors into a new file; returns its path. "": beside the database's
  /// file, with the time (UTC) in its name.
  std::string save(const std::string& path) const;
  TransferResult export_to(const std::string& path, const std::vector<std::string>& names,
                           bool overwrite) const;
  /// `on_conflict`: "refuse" (or ""), "replace" or "merge".
  TransferResult import_from(const std::string& path, const std::vector<std::string>& names,
                             const std::string& on_conflict);

  /// Makes a view and stores it, with advice on its quality. `source_name` says where the picture
  /// comes from, e.g. the camera's topic.
  TaughtPicture teach(const std::string& object, const ViewSource& source,
                      const std::string& source_name);

 private:
  /// What pictures are recognised with.
  struct Known {
    std::shared_ptr<Recognizer> recognizer;
    NodeOptions options;
    std::map<std::string, double> heights;
    DatabaseState database;
  };

  [[nodiscard]] DatabaseState read_state(const std::vector<std::string>& active) const;
  void reload(const std::vector<std::string>& active);  ///< with changing_ held, as the next one
  void follow_database();
  [[nodiscard]] std::shared_ptr<const Known> known() const;
  void set_known(Known known, bool changed);
  void add_poses(const Known& with, const std::optional<Camera>& camera, Findings& findings);

  std::shared_ptr<ObjectStore> store_;
  mutable std::mutex changing_;  ///< one change after the other, however long the database takes
  mutable std::mutex mutex_;     ///< of the next two; for moments only
  std::shared_ptr<const Known> known_;
  bool changed_ = false;

  ReliefCache reliefs_;

  std::mutex tracker_mutex_;
  Tracker tracker_;

  std::optional<Follower> follower_;  // the last member: it uses the others
};

/// Where the object is by the method of `source`, for the store: "mask", "background", "roi",
/// "whole".
[[nodiscard]] std::string method_of(const ViewSource& source);

}  // namespace posevote::logic
