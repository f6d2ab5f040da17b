// Declaration of the SQLite store; reading.cpp and writing.cpp define it.
#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Transaction.h>

#include <mutex>

#include "posevote/store/sqlite/connection.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"
#include "posevote/store/stored_view.hpp"

namespace posevote::sqlite {

/// Notes stand in the table meta beside what the store itself keeps there.
inline const std::string note_prefix = "note ";

class SqliteStore : public ObjectStore {
 public:
  SqliteStore(std::string path, const SqliteOptions& options);

  const std::string& location() const override { return path_; }
  bool read_only() const override;
  std::int64_t size_bytes() const override;
  std::int64_t version() const override;
  std::optional<FeatureRecord> features() const override;
  std::vector<ObjectSummary> list() const override;
  std::vector<ViewSummary> views(const std::string& object) const override;
  TaughtView view(const std::string& object, const std::string& id) const override;
  std::shared_ptr<const ModelSet> load(const LoadOptions& options) const override;
  ObjectModel load_object(const std::string& name, const LoadOptions& options) const override;
  std::vector<ImpostorSummary> impostors() const override;
  Impostor impostor(const std::string& id) const override;
  std::string note(const std::string& key) const override;
  Derived derived(const std::string& key) const override;

  AddResult add_view(const std::string& object, const TaughtView& view,
                     const FeatureRecord& features) override;
  void remove_object(const std::string& name) override;
  void remove_view(const std::string& object, const std::string& id) override;
  void rename_object(const std::string& from, const std::string& to) override;
  AddResult add_impostor(const Impostor& impostor, const FeatureRecord& features) override;
  void remove_impostor(const std::string& id) override;
  void set_note(const std::string& key, const std::string& text) override;
  void set_derived(const std::string& key, const Derived& derived) override;
  void rebuild(const FeatureRecord& features, const FeatureMaker& maker) override;
  void transact(const std::function<void()>& work) override;

 private:
  /// Runs `work` on one snapshot of the database.
  template <class Work>
  std::invoke_result_t<Work> reading(Work work) const {
    const std::lock_guard lock(mutex_);
    return guarded(path_, [&] {
      if (writing_) return work();
      const SQLite::Transaction snapshot(database_);
      return work();
    });
  }

  [[noreturn]] void fail(ErrorCode code, const std::string& reason) const {
    throw_database_error(code, path_, reason);
  }
  std::string meta(const std::string& key) const;
  std::int64_t object_id(const std::string& name) const;

  std::optional<FeatureRecord> recorded_features() const;
  void require_features(const FeatureRecord& features);
  void record(const FeatureRecord& features);

  struct ViewReader;  ///< what reading many views needs, prepared once
  ViewReader view_reader() const;
  View read_view(SQLite::Statement& row, const std::string& signature) const;
  void keep_patch(std::int64_t view, const Blob& patch);
  std::shared_ptr<const View> load_view(std::int64_t row, ViewReader& reader,
                                        const LoadOptions& options) const;
  std::vector<std::shared_ptr<const View>> load_views(std::int64_t object, ViewReader& reader,
                                                      const LoadOptions& options) const;
  std::string insert_view(std::int64_t object, const TaughtView& view, const std::string& identity,
                          const std::string& signature);
  std::vector<std::int64_t> row_ids(const std::string& table) const;
  void rebuild_view(std::int64_t row, const FeatureRecord& features, const FeatureMaker& maker);
  void rebuild_impostor(std::int64_t row, const FeatureMaker& maker);

  std::string path_;
  mutable std::recursive_mutex mutex_;  // recursive: `transact` calls back into the store
  mutable SQLite::Database database_;
  mutable ViewCache cache_;
  bool writing_ = false;
};

}  // namespace posevote::sqlite
