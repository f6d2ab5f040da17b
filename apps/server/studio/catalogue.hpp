// What is known: the object store, and the recogniser that is kept up to date with it.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "live/bell.hpp"
#include "posevote/recognize/recognizer.hpp"
#include "posevote/store/object_store.hpp"
#include "studio/settings.hpp"

namespace posevote::server {

/// Safe for many threads.
class Catalogue {
 public:
  /// Rings `bell` when the objects have changed.
  Catalogue(std::unique_ptr<ObjectStore> store, const Settings& settings, Bell& bell);

  [[nodiscard]] ObjectStore& store() { return *store_; }
  [[nodiscard]] const ObjectStore& store() const { return *store_; }

  /// Takes over what was taught, deleted, set, by whomever: recognition uses it when this returns.
  void refresh();

  /// Not null. Recognition in hand goes on with the one that it has.
  [[nodiscard]] std::shared_ptr<const Recognizer> recognizer() const;
  /// As of the last refresh.
  [[nodiscard]] std::int64_t version() const;

  /// The features that views must have to stand in the database.
  [[nodiscard]] FeatureOptions features() const;
  [[nodiscard]] TeachOptions teach_options() const;

 private:
  std::unique_ptr<ObjectStore> store_;
  const Settings& settings_;
  Bell& bell_;
  std::mutex refreshing_;  ///< one at a time; held while models are loaded
  mutable std::mutex mutex_;
  std::shared_ptr<Recognizer> recognizer_;
  std::int64_t version_ = -1;
  int generation_ = -1;
};

/// Copies all views of object `from_name` to object `to_name`, which is made if it is new, as one
/// change. Returns the results in the order of the views.
std::vector<AddResult> copy_views(const ObjectStore& from, const std::string& from_name,
                                  ObjectStore& to, const std::string& to_name);

/// Is there an object of that name?
[[nodiscard]] bool has_object(const ObjectStore& store, const std::string& name);

}  // namespace posevote::server
