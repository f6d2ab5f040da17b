#include "posevote/core/error.hpp"
#include "posevote/store/address.hpp"
#include "posevote/store/postgres/postgres_store_impl.hpp"
#include "posevote/store/postgres/rows.hpp"
#include "posevote/store/postgres/schema.hpp"

namespace posevote {
namespace postgres {
namespace {

/// Has the server tell of changes; what it tells is asked for afterwards.
class Receiver : public pqxx::notification_receiver {
 public:
  explicit Receiver(pqxx::connection_base& connection)
      : pqxx::notification_receiver(connection, postgres::channel) {}
  void operator()(const std::string&, int) override {}
};

struct Listener : Link {
  explicit Listener(const std::string& address) : Link(address) {}
  Receiver receiver{connection};
};

}  // namespace

PostgresStore::PostgresStore(const std::string& address, const PostgresOptions& options)
    : address_(complete_address(address, options)),
      location_(without_passwords(address)),
      options_(options) {
  guarded(location_, address_, [&] { prepare(options.access); });
}

Link& PostgresStore::link() const {
  if (!link_) link_ = std::make_unique<Link>(address_);
  return *link_;
}

/// Makes sure that the connection is there: it may have been lost since it was used last.
void PostgresStore::revive() const {
  try {
    pqxx::nontransaction(link().connection).exec("SELECT 1");
  } catch (const pqxx::pqxx_exception&) {
    link_.reset();
    link();
  }
}

void PostgresStore::prepare(Access access) {
  pqxx::work work(link().connection);
  const int present = present_schema(work);
  if (present > newest_schema)
    fail(ErrorCode::database_unusable, "was made by a newer version of posevote (schema " +
                                           std::to_string(present) + ", this one knows " +
                                           std::to_string(newest_schema) + "); update posevote");
  if (present == newest_schema) return;
  if (present == 0 && access != Access::create)
    fail(ErrorCode::not_found, "holds no objects yet; teach one first: posevote teach --help");
  if (access == Access::read_only || !may_migrate(work))
    fail(ErrorCode::database_unusable,
         present == 0
             ? "has no tables of posevote yet, and this user may not make them; let its "
               "owner open it once"
             : "is of an older version of posevote, and this user may not change that; let "
               "its owner open it once");
  migrate(work);
  work.commit();
}

bool PostgresStore::has_right(const std::string& right) const {
  if (options_.access == Access::read_only) return false;
  return reading([&] {
    return work_
        ->exec_params1(
            "SELECT has_table_privilege('posevote.view', $1) AND NOT pg_is_in_recovery()", right)[0]
        .as<bool>();
  });
}

bool PostgresStore::read_only() const {
  return !has_right("INSERT");
}

bool PostgresStore::may_remove() const {
  return has_right("DELETE");
}

std::int64_t PostgresStore::size_bytes() const {
  return reading([&] {
    return work_->exec1("SELECT pg_database_size(current_database())")[0].as<std::int64_t>();
  });
}

std::int64_t PostgresStore::version() const {
  return reading([&] {
    return work_->exec1("SELECT value FROM posevote.meta WHERE key = 'changes'")[0]
        .as<std::int64_t>();
  });
}

bool PostgresStore::wait_for_change(std::int64_t known, std::chrono::milliseconds timeout) const {
  using std::chrono::microseconds;
  const std::lock_guard lock(listening_);
  return guarded(location_, address_, [&] {
    try {
      if (!listener_) listener_ = std::make_unique<Listener>(address_);
      pqxx::connection& connection = listener_->connection;
      const auto changed = [&] {
        pqxx::nontransaction ask(connection);
        return ask.exec1("SELECT value FROM posevote.meta WHERE key = 'changes'")[0]
                   .as<std::int64_t>() != known;
      };
      const auto end = std::chrono::steady_clock::now() + timeout;
      while (!changed()) {
        const auto left =
            std::chrono::duration_cast<microseconds>(end - std::chrono::steady_clock::now());
        if (left <= microseconds::zero()) return false;
        connection.await_notification(left.count() / 1000000, left.count() % 1000000);
      }
      return true;
    } catch (const pqxx::pqxx_exception&) {
      listener_.reset();
      throw;
    }
  });
}

std::optional<FeatureRecord> PostgresStore::features() const {
  return reading([&] { return recorded_features(); });
}

std::optional<FeatureRecord> PostgresStore::recorded_features() const {
  const auto row = work_->exec(
      "SELECT signature, settings FROM posevote.features WHERE EXISTS (SELECT 1 FROM "
      "posevote.view) OR EXISTS (SELECT 1 FROM posevote.impostor)");
  if (row.empty()) return std::nullopt;
  return FeatureRecord{row[0][0].c_str(), row[0][1].c_str()};
}

std::int64_t PostgresStore::object_id(const std::string& name) const {
  const auto row = work_->exec_params("SELECT id FROM posevote.object WHERE name = $1", name);
  if (row.empty()) fail(ErrorCode::not_found, "holds no object '" + name + "'");
  return row[0][0].as<std::int64_t>();
}

std::vector<ObjectSummary> PostgresStore::list() const {
  return reading([&] {
    std::vector<ObjectSummary> objects;
    for (const pqxx::row row :
         work_->exec("SELECT name, count(*), sum(features), min(taught_at), max(taught_at) FROM "
                     "posevote.object o JOIN posevote.view v ON v.object = o.id GROUP BY o.id "
                     "ORDER BY name"))
      objects.push_back({row[0].c_str(), row[1].as<int>(), row[2].as<std::int64_t>(),
                         row[3].c_str(), row[4].c_str()});
    return objects;
  });
}

std::vector<ViewSummary> PostgresStore::views(const std::string& object) const {
  return reading([&] {
    std::vector<ViewSummary> views;
    for (const pqxx::row row : work_->exec_params(
             "SELECT number, identity, hash, yaw_deg, width, height, features, coverage, method, "
             "source, taught_at, version FROM posevote.view WHERE object = $1 ORDER BY number",
             object_id(object)))
      views.push_back({row[0].c_str(),
                       row[1].c_str(),
                       row[2].c_str(),
                       yaw_of(row[3]),
                       {row[4].as<int>(), row[5].as<int>()},
                       row[6].as<int>(),
                       row[7].as<double>(),
                       row[8].c_str(),
                       provenance_of(row)});
    return views;
  });
}

View PostgresStore::read_view(const pqxx::row& row, const std::string& signature) const {
  return checked_view([&] { return view_of(row); }, row["identity"].c_str(), signature, location_);
}

TaughtView PostgresStore::view(const std::string& object, const std::string& id) const {
  return reading([&] {
    const auto found =
        work_->exec_params("SELECT * FROM posevote.view WHERE object = $1 AND number::text = $2",
                           object_id(object), id);
    if (found.empty())
      fail(ErrorCode::not_found, "holds no view '" + id + "' of object '" + object + "'");
    const pqxx::row row = found[0];
    TaughtView taught;
    taught.view = read_view(row, recorded_features()->signature);
    taught.picture = blob_of(row["picture"]);
    taught.mask = blob_of(row["mask"]);
    taught.method = row["method"].c_str();
    taught.provenance = provenance_of(row);
    check_picture(taught, row["identity"].c_str(), id, location_);
    return taught;
  });
}

std::shared_ptr<const View> PostgresStore::load_view(std::int64_t id,
                                                     const LoadOptions& options) const {
  const pqxx::row row = work_->exec_params1(
      "SELECT number, identity, hash, yaw_deg, width, height, centre_x, centre_y, dimension, "
      "outline, keypoints, descriptors, patch, (SELECT signature FROM posevote.features) AS "
      "signature FROM posevote.view WHERE id = $1",
      id);
  View view = read_view(row, row["signature"].c_str());
  const Blob patch = blob_of(row["patch"]);
  const auto fetch = [&] {
    const pqxx::row pictures =
        work_->exec_params1("SELECT picture, mask FROM posevote.view WHERE id = $1", id);
    return std::pair(blob_of(pictures[0]), blob_of(pictures[1]));
  };
  halve_descriptors(view.features);
  add_pictures(view, {patch.data(), patch.size()}, options.pictures, fetch, location_);
  return std::make_shared<const View>(std::move(view));
}

std::vector<std::shared_ptr<const View>> PostgresStore::load_views(
    std::int64_t object, const LoadOptions& options) const {
  std::vector<std::shared_ptr<const View>> views;
  for (const pqxx::row row : work_->exec_params(
           "SELECT id, number, hash FROM posevote.view WHERE object = $1 ORDER BY number",
           object)) {
    const std::string key = std::string(row[2].c_str()) + '/' + row[1].c_str() +
                            (options.pictures ? " with pictures" : "");
    views.push_back(cache_.get(key, [&] { return load_view(row[0].as<std::int64_t>(), options); }));
  }
  return views;
}

std::vector<Features> PostgresStore::load_impostors() const {
  std::vector<Features> all;
  std::map<std::string, Features> known;
  // A row that was written anew lies elsewhere, or was written by another transaction.
  for (const pqxx::row row :
       work_->exec("SELECT id, ctid, xmin FROM posevote.impostor ORDER BY id")) {
    const std::string key =
        std::string(row[0].c_str()) + '/' + row[1].c_str() + '/' + row[2].c_str();
    auto kept = impostors_.extract(key);
    const auto place = kept ? known.insert(std::move(kept)).position
                            : known
                                  .emplace(key, features_of(work_->exec_params1(
                                                    "SELECT keypoints, descriptors, dimension FROM "
                                                    "posevote.impostor WHERE id = $1",
                                                    row[0].as<std::int64_t>())))
                                  .first;
    all.push_back(place->second);
  }
  impostors_.swap(known);
  return all;
}

ObjectModel PostgresStore::load_object(const std::string& name, const LoadOptions& options) const {
  return reading([&] { return ObjectModel{name, load_views(object_id(name), options)}; });
}

std::shared_ptr<const ModelSet> PostgresStore::load(const LoadOptions& options) const {
  return reading([&]() -> std::shared_ptr<const ModelSet> {
    cache_.tidy();
    const auto features = recorded_features();
    if (!features) return std::make_shared<const ModelSet>();
    std::vector<ObjectModel> objects;
    for (const pqxx::row row : work_->exec("SELECT id, name FROM posevote.object ORDER BY name"))
      objects.push_back({row[1].c_str(), load_views(row[0].as<std::int64_t>(), options)});
    return std::make_shared<const ModelSet>(features->signature, std::move(objects),
                                            load_impostors());
  });
}

std::vector<ImpostorSummary> PostgresStore::impostors() const {
  return reading([&] {
    std::vector<ImpostorSummary> impostors;
    for (const pqxx::row row : work_->exec("SELECT id, identity, features, source, taught_at, "
                                           "version FROM posevote.impostor ORDER BY id"))
      impostors.push_back({row[0].c_str(), row[1].c_str(), row[2].as<int>(), provenance_of(row)});
    return impostors;
  });
}

Impostor PostgresStore::impostor(const std::string& id) const {
  return reading([&] {
    const auto found =
        work_->exec_params("SELECT * FROM posevote.impostor WHERE id::text = $1", id);
    if (found.empty()) fail(ErrorCode::not_found, "holds no impostor '" + id + "'");
    const pqxx::row row = found[0];
    return Impostor{id, features_of(row), blob_of(row["picture"]), provenance_of(row)};
  });
}

std::string PostgresStore::note(const std::string& key) const {
  return reading([&]() -> std::string {
    const auto row = work_->exec_params("SELECT text FROM posevote.note WHERE key = $1", key);
    return row.empty() ? "" : row[0][0].c_str();
  });
}

Derived PostgresStore::derived(const std::string& key) const {
  return reading([&]() -> Derived {
    const auto row =
        work_->exec_params("SELECT version, bytes FROM posevote.derived WHERE key = $1", key);
    if (row.empty()) return {};
    return {row[0][0].as<std::int64_t>(), pqxx::binarystring(row[0][1]).str()};
  });
}

}  // namespace postgres

std::unique_ptr<ObjectStore> open_postgres_store(const std::string& address,
                                                 const PostgresOptions& options) {
  return std::make_unique<postgres::PostgresStore>(address, options);
}

}  // namespace posevote
