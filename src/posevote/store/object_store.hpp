// Where taught objects are kept, whatever the database is.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "posevote/model/model_set.hpp"
#include "posevote/store/feature_record.hpp"
#include "posevote/store/taught_view.hpp"

namespace posevote {

enum class Access {
  create,    ///< read and write, made when it is not there
  existing,  ///< read and write; read-only where writing is not permitted
  read_only,
};

struct ObjectSummary {
  std::string name;
  int views = 0;
  std::int64_t features = 0;
  std::string first_taught_at, last_taught_at;  ///< UTC, ISO 8601
};

struct ViewSummary {
  std::string id;
  std::string identity;  ///< hash of what was taught: picture, mask, yaw
  std::string hash;      ///< View::hash: of that and the features made of it
  double yaw_deg = 0;    ///< NaN: unknown
  cv::Size image_size;
  int features = 0;
  double coverage = 0;  ///< share of the picture that the object covers
  std::string method;
  Provenance provenance;
};

struct ImpostorSummary {
  std::string id;
  std::string identity;  ///< hash of its picture
  int features = 0;
  Provenance provenance;
};

struct AddResult {
  std::string id;
  bool added = true;  ///< false: it was there already, under this id
};

/// Bytes that are made of the objects.
struct Derived {
  std::int64_t version = 0;  ///< `ObjectStore::version` of what they were made of
  std::string bytes;
};

struct LoadOptions {
  bool pictures = false;  ///< also decode View::picture and View::mask
};

/// Makes a stored view's features again from its encoded picture and mask (empty: none).
using FeatureMaker = std::function<Features(const std::vector<std::uint8_t>& picture,
                                            const std::vector<std::uint8_t>& mask)>;

/// Safe to call from many threads and processes at once. Every change is all or nothing and on the
/// disk when the call returns; a process that dies loses at most the change in hand.
///
/// Errors of all members: not_found for names and ids that are not there, invalid_argument for
/// names that may not be (see object_name.hpp), already_exists, io (not permitted, disk full, busy
/// for too long, connection lost), database_unusable when stored data turns out to be damaged. The
/// message names the database.
class ObjectStore {
 public:
  virtual ~ObjectStore() = default;

  [[nodiscard]] virtual const std::string& location() const = 0;
  [[nodiscard]] virtual bool read_only() const = 0;
  /// Whether this user may also remove and rename.
  [[nodiscard]] virtual bool may_remove() const { return !read_only(); }

  /// What it takes up where it is kept, with whatever else the same database holds.
  [[nodiscard]] virtual std::int64_t size_bytes() const = 0;

  /// Grows with every change, whichever process made it.
  [[nodiscard]] virtual std::int64_t version() const = 0;

  /// Waits until `version()` is no longer `known`; false when that does not happen within
  /// `timeout`. Other calls go on meanwhile.
  [[nodiscard]] virtual bool wait_for_change(std::int64_t known,
                                             std::chrono::milliseconds timeout) const;

  /// The features that all views have in common; empty as long as there are none.
  [[nodiscard]] virtual std::optional<FeatureRecord> features() const = 0;

  /// By name.
  [[nodiscard]] virtual std::vector<ObjectSummary> list() const = 0;
  /// In the order in which they were taught.
  [[nodiscard]] virtual std::vector<ViewSummary> views(const std::string& object) const = 0;
  [[nodiscard]] virtual TaughtView view(const std::string& object, const std::string& id) const = 0;

  /// One consistent snapshot of everything. Views that an earlier snapshot, still alive, holds with
  /// the same content are the same objects in memory. Their descriptors are half floats (CV_16F);
  /// `view` gives them as they were taught.
  [[nodiscard]] virtual std::shared_ptr<const ModelSet> load(
      const LoadOptions& options = {}) const = 0;
  [[nodiscard]] virtual ObjectModel load_object(const std::string& name,
                                                const LoadOptions& options = {}) const = 0;

  /// Adds a view to the object of that name, which is made if it is new. The same picture with the
  /// same mask and yaw is stored once. Throws Error{feature_mismatch} when the database holds
  /// others.
  virtual AddResult add_view(const std::string& object, const TaughtView& view,
                             const FeatureRecord& features) = 0;
  virtual void remove_object(const std::string& name) = 0;
  /// Removing the last view removes the object.
  virtual void remove_view(const std::string& object, const std::string& id) = 0;
  virtual void rename_object(const std::string& from, const std::string& to) = 0;

  [[nodiscard]] virtual std::vector<ImpostorSummary> impostors() const = 0;
  [[nodiscard]] virtual Impostor impostor(const std::string& id) const = 0;
  virtual AddResult add_impostor(const Impostor& impostor, const FeatureRecord& features) = 0;
  virtual void remove_impostor(const std::string& id) = 0;

  /// A text that is kept beside the objects under a key of the caller's; "" when there is none.
  [[nodiscard]] virtual std::string note(const std::string& key) const = 0;
  virtual void set_note(const std::string& key, const std::string& text) = 0;

  /// What was kept under a key by `set_derived`; empty when there is none.
  [[nodiscard]] virtual Derived derived(const std::string& key) const = 0;
  /// Keeps bytes that are made of the objects and could be made again, such as a search index. No
  /// change to `version()`, and not for use within `transact`.
  virtual void set_derived(const std::string& key, const Derived& derived) = 0;

  /// Makes the features of all views and impostors again, as one change. What `maker` throws ends
  /// it.
  virtual void rebuild(const FeatureRecord& features, const FeatureMaker& maker) = 0;

  /// Makes all changes that `work` makes through this object one change: an exception undoes them
  /// all.
  virtual void transact(const std::function<void()>& work) = 0;
};

}  // namespace posevote
