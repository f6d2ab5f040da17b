#include "logic/object_recognition.hpp"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "logic/active_set.hpp"
#include "posevote/core/error.hpp"
#include "posevote/store/open_store.hpp"
#include "posevote/teach/quality.hpp"

namespace posevote::logic {
namespace {

namespace fs = std::filesystem;

NodeOptions with_settings(NodeOptions options, const Settings& settings) {
  const OptionList list = list_options(options);
  for (const auto& [name, text] : settings) list.set(name, text);
  list.validate();
  (void)parse_heights(options.object_heights);
  options.teach.feature = options.recognize.feature;
  return options;
}

/// The preset, then the database's features, then what was set.
NodeOptions starting_options(const Settings& settings, const ObjectStore& store) {
  NodeOptions options;
  const auto preset = settings.find("preset");
  if (preset != settings.end()) options.recognize = make_preset(preset->second);
  const auto record = store.features();
  const auto kind = settings.find("feature.kind");
  if (record && (kind == settings.end() || recorded_options(*record).kind == kind->second))
    options.recognize.feature = recorded_options(*record);
  return with_settings(options, settings);
}

std::unique_ptr<ObjectStore> open_database(const Settings& settings) {
  const auto given = settings.find("database");
  const std::string path = database_path(given == settings.end() ? "" : given->second);
  const fs::path folder = fs::path(path).parent_path();
  if (!is_server_address(path) && !folder.empty()) {
    std::error_code ignored;  // opening says what is wrong
    fs::create_directories(folder, ignored);
  }
  return open_store(path);
}

std::string timestamp() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  (void)std::strftime(text, sizeof text, "%Y%m%d-%H%M%S", &utc);
  return text;
}

OnConflict parse_conflict(const std::string& text) {
  if (text.empty() || text == "refuse") return OnConflict::refuse;
  if (text == "replace") return OnConflict::replace;
  if (text == "merge") return OnConflict::merge;
  throw Error(ErrorCode::invalid_argument,
              "on_conflict is refuse, replace or merge, not '" + text + "'");
}

const ObjectModel* find_object(const ModelSet& models, const std::string& name) {
  for (const ObjectModel& object : models.objects())
    if (object.name == name) return &object;
  return nullptr;
}

const View* find_view(const ObjectModel& object, const std::string& id) {
  for (const auto& view : object.views)
    if (view->id == id) return view.get();
  return nullptr;
}

std::vector<std::uint8_t> encode(const cv::Mat& picture) {
  std::vector<std::uint8_t> png;
  cv::imencode(".png", picture, png);
  return png;
}

}  // namespace

bool DatabaseState::is_active(const std::string& object) const {
  return active.empty() || std::find(active.begin(), active.end(), object) != active.end();
}

int DatabaseState::place_of(const std::string& object) const {
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (objects[i].name == object) return static_cast<int>(i);
  return -1;
}

ObjectRecognition::ObjectRecognition(const Settings& settings) : store_(open_database(settings)) {
  Known first;
  first.options = starting_options(settings, *store_);
  first.heights = parse_heights(first.options.object_heights);
  first.database = read_state({});
  first.recognizer = std::make_shared<Recognizer>(store_->load(), first.options.recognize);
  tracker_.set_options(first.options.track);
  const std::int64_t version = first.database.version;
  set_known(std::move(first), true);
  follower_.emplace(store_, version, [this](const auto&) {
    const std::lock_guard lock(changing_);
    follow_database();
  });
}

DatabaseState ObjectRecognition::read_state(const std::vector<std::string>& active) const {
  DatabaseState state;
  state.version = store_->version();  // what is changed from now on counts as new
  state.location = store_->location();
  state.read_only = store_->read_only();
  state.objects = store_->list();
  state.active = active;
  if (const auto record = store_->features()) state.features = recorded_options(*record).kind;
  return state;
}

void ObjectRecognition::reload(const std::vector<std::string>& active) {
  Known next = *known();
  next.database = read_state(active);
  const auto record = store_->features();
  const auto models = select_objects(store_->load(), active);
  if (record && record->signature != next.options.recognize.feature.signature()) {
    // Taught or rebuilt with other features by another program.
    next.options.recognize.feature = next.options.teach.feature = recorded_options(*record);
    next.recognizer = std::make_shared<Recognizer>(models, next.options.recognize);
  } else {
    next.recognizer->set_models(models);
  }
  set_known(std::move(next), true);
}

void ObjectRecognition::follow_database() {
  const DatabaseState state = known()->database;
  if (store_->version() != state.version) reload(state.active);
}

std::shared_ptr<const ObjectRecognition::Known> ObjectRecognition::known() const {
  const std::lock_guard lock(mutex_);
  return known_;
}

void ObjectRecognition::set_known(Known known, bool changed) {
  auto next = std::make_shared<const Known>(std::move(known));
  const std::lock_guard lock(mutex_);
  known_.swap(next);
  changed_ = changed_ || changed;
}

bool ObjectRecognition::changed() {
  const std::lock_guard lock(mutex_);
  return std::exchange(changed_, false);
}

void ObjectRecognition::add_poses(const Known& with, const std::optional<Camera>& camera,
                                  Findings& findings) {
  if (!camera || !camera->is_calibrated()) return;
  Camera used = scale_camera(*camera, findings.result.image_size);
  if (with.options.rectified) used = rectify_camera(used);
  const auto models = with.recognizer->models();
  for (FoundObject& object : findings.objects) try {
      const auto height = with.heights.find(object.detection.object);
      const ObjectModel* model = find_object(*models, object.detection.object);
      const View* view = model ? find_view(*model, object.detection.view) : nullptr;
      if (height != with.heights.end() && view)
        object.pose =
            find_pose(object.detection, *view, height->second, used, reliefs_.find(*model, *view));
      object.outline =
          object.pose ? object.pose->outline
                      : outline_at(object.detection.outline, used, with.options.marker_distance_m);
    } catch (const Error& error) {
      findings.problem = error.what();
    }
}

Findings ObjectRecognition::recognize_once(const cv::Mat& picture,
                                           const std::optional<Camera>& camera) {
  const auto with = known();
  Findings findings;
  findings.result = with->recognizer->recognize(picture);
  for (const Detection& detection : findings.result.detections)
    findings.objects.push_back({detection, {}, "", std::nullopt, {}});
  add_poses(*with, camera, findings);
  return findings;
}

Findings ObjectRecognition::recognize(const cv::Mat& picture, const std::optional<Camera>& camera) {
  Findings findings = recognize_once(picture, camera);
  std::vector<Sighting> sightings;
  for (const FoundObject& object : findings.objects)
    sightings.push_back({object.detection.object, object.detection.box});
  const std::string prefix = options().frame_prefix;
  const std::lock_guard lock(tracker_mutex_);
  const std::vector<Track> tracks = tracker_.update(sightings);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    FoundObject& object = findings.objects[i];
    object.track = tracks[i];
    object.frame = track_frame(prefix, object.detection.object, tracks[i]);
  }
  return findings;
}

NodeOptions ObjectRecognition::options() const {
  return known()->options;
}

void ObjectRecognition::set(const Settings& settings) {
  for (const auto& [name, text] : settings)
    if (is_read_at_start(name))
      throw Error(
          ErrorCode::invalid_argument,
          "option '" + name + "' is read when the node starts; start it again to change it");
  const std::lock_guard lock(changing_);
  Known next = *known();
  next.options = with_settings(next.options, settings);
  next.heights = parse_heights(next.options.object_heights);
  next.recognizer = std::make_shared<Recognizer>(next.recognizer->models(), next.options.recognize);
  const TrackOptions track = next.options.track;
  set_known(std::move(next), false);
  const std::lock_guard tracker_lock(tracker_mutex_);
  tracker_.set_options(track);
}

DatabaseState ObjectRecognition::database() const {
  DatabaseState state = known()->database;
  state.problem = follower_->problem();
  return state;
}

void ObjectRecognition::set_active(const std::vector<std::string>& names) {
  const std::lock_guard lock(changing_);
  const auto objects = store_->list();
  for (const std::string& name : names)
    if (std::none_of(objects.begin(), objects.end(),
                     [&](const ObjectSummary& object) { return object.name == name; }))
      throw Error(ErrorCode::not_found,
                  "'" + store_->location() + "' holds no object '" + name + "'");
  reload(names);
}

void ObjectRecognition::remove(const std::string& object, const std::string& view) {
  const std::lock_guard lock(changing_);
  if (view.empty())
    store_->remove_object(object);
  else
    store_->remove_view(object, view);
  follow_database();
}

void ObjectRecognition::rename(const std::string& from, const std::string& to) {
  const std::lock_guard lock(changing_);
  store_->rename_object(from, to);
  std::vector<std::string> active = known()->database.active;
  std::replace(active.begin(), active.end(), from, to);
  reload(active);
}

std::string ObjectRecognition::save(const std::string& path) const {
  const std::lock_guard lock(changing_);
  std::string target = path;
  if (target.empty()) {
    if (is_server_address(store_->location()))
      throw Error(ErrorCode::invalid_argument,
                  "a database on a server has no folder to save a copy in; give a path");
    fs::path beside = store_->location();
    beside.replace_filename(beside.stem().string() + "-" + timestamp() + ".db");
    target = beside.string();
  }
  (void)save_copy(*store_, target);
  return target;
}

TransferResult ObjectRecognition::export_to(const std::string& path,
                                            const std::vector<std::string>& names,
                                            bool overwrite) const {
  const std::lock_guard lock(changing_);
  return export_objects(*store_, path, names, overwrite);
}

TransferResult ObjectRecognition::import_from(const std::string& path,
                                              const std::vector<std::string>& names,
                                              const std::string& on_conflict) {
  const OnConflict conflict = parse_conflict(on_conflict);
  const std::lock_guard lock(changing_);
  const TransferResult result = import_objects(path, *store_, names, conflict);
  follow_database();
  return result;
}

TaughtPicture ObjectRecognition::teach(const std::string& object, const ViewSource& source,
                                       const std::string& source_name) {
  const NodeOptions options = this->options();
  TaughtView taught;
  taught.view = teach_view(source, options.teach);
  taught.picture = encode(source.picture);
  taught.method = method_of(source);
  taught.provenance.source = source_name;

  TaughtPicture made;
  made.features = static_cast<int>(taught.view.features.size());
  made.mask = taught.view.mask;
  std::vector<std::shared_ptr<const View>> others;
  {
    const std::lock_guard lock(changing_);
    const auto objects = store_->list();
    if (std::any_of(objects.begin(), objects.end(),
                    [&](const ObjectSummary& known) { return known.name == object; }))
      others = store_->load_object(object).views;
    made.added = store_->add_view(object, taught, record_features(options.recognize.feature)).added;
    follow_database();
  }
  QualityOptions quality;
  quality.feature = options.teach.feature;
  made.advice = assess_view(taught.view, others, quality).advice;
  return made;
}

std::string method_of(const ViewSource& source) {
  if (!source.mask.empty()) return "mask";
  if (!source.background.empty()) return "background";
  return source.roi ? "roi" : "whole";
}

}  // namespace posevote::logic
