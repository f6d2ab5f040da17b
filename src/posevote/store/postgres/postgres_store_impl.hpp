// Declaration of the PostgreSQL store; reading.cpp and writing.cpp define it.
#pragma once

#include <map>
#include <mutex>

#include "posevote/store/blob.hpp"
#include "posevote/store/postgres/connection.hpp"
#include "posevote/store/postgres/postgres_store.hpp"
#include "posevote/store/stored_view.hpp"

namespace posevote::postgres {

class PostgresStore : public ObjectStore {
 public:
  PostgresStore(const std::string& address, const PostgresOptions& options);

  const std::string& location() const override { return location_; }
  bool read_only() const override;
  bool may_remove() const override;
  std::int64_t size_bytes() const override;
  std::int64_t version() const override;
  bool wait_for_change(std::int64_t known, std::chrono::milliseconds timeout) const override;
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
  /// Takes note of the transaction in hand, as long as it lives.
  struct Current {
    pqxx::transaction_base*& work;
    Current(pqxx::transaction_base*& w, pqxx::transaction_base& now) : work(w) { work = &now; }
    ~Current() { work = nullptr; }
  };
  using Snapshot = pqxx::transaction<pqxx::repeatable_read, pqxx::read_only>;

  /// Runs `work` on one snapshot of the database, again when the connection breaks meanwhile.
  template <class Work>
  std::invoke_result_t<Work> reading(Work work) const {
    const std::lock_guard lock(mutex_);
    return guarded(location_, address_, [&] {
      if (work_) return work();
      const auto once = [&] {
        Snapshot snapshot(link().connection);
        const Current current(work_, snapshot);
        return work();
      };
      try {
        return once();
      } catch (const pqxx::pqxx_exception&) {
        if (link_ && link_->connection.is_open()) throw;
        link_.reset();
        return once();
      }
    });
  }

  [[noreturn]] void fail(ErrorCode code, const std::string& reason) const {
    throw_database_error(code, location_, reason);
  }
  Link& link() const;
  void revive() const;
  bool has_right(const std::string& right) const;
  void prepare(Access access);
  std::int64_t object_id(const std::string& name) const;

  std::optional<FeatureRecord> recorded_features() const;
  void require_features(const FeatureRecord& features);
  void record(const FeatureRecord& features);

  View read_view(const pqxx::row& row, const std::string& signature) const;
  std::shared_ptr<const View> load_view(std::int64_t row, const LoadOptions& options) const;
  std::vector<std::shared_ptr<const View>> load_views(std::int64_t object,
                                                      const LoadOptions& options) const;
  std::vector<Features> load_impostors() const;
  std::string insert_view(std::int64_t object, const TaughtView& view, const std::string& identity,
                          const std::string& signature);
  void rebuild_view(std::int64_t row, const FeatureRecord& features, const FeatureMaker& maker);
  void rebuild_impostor(std::int64_t row, const FeatureMaker& maker);

  std::string address_, location_;
  PostgresOptions options_;
  mutable std::recursive_mutex mutex_;  // recursive: `transact` calls back into the store
  mutable std::unique_ptr<Link> link_;
  mutable pqxx::transaction_base* work_ = nullptr;
  mutable ViewCache cache_;
  mutable std::map<std::string, Features> impostors_;  // those of the last snapshot
  mutable std::mutex listening_;
  mutable std::unique_ptr<Link> listener_;
};

}  // namespace posevote::postgres
