#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <sqlite3.h>

#include <filesystem>

#include "posevote/core/error.hpp"
#include "posevote/store/sqlite/rows.hpp"
#include "posevote/store/sqlite/sqlite_store_impl.hpp"

namespace posevote {
namespace sqlite {

using SQLite::Statement;

SqliteStore::SqliteStore(std::string path, const SqliteOptions& options)
    : path_(std::move(path)), database_(connect(path_, options)) {}

bool SqliteStore::read_only() const {
  const std::lock_guard lock(mutex_);
  return sqlite3_db_readonly(database_.getHandle(), "main") != 0;
}

std::string SqliteStore::meta(const std::string& key) const {
  Statement select(database_, "SELECT value FROM meta WHERE key = ?");
  select.bind(1, key);
  if (!select.executeStep())
    fail(ErrorCode::database_unusable, "is damaged: its '" + key + "' is missing");
  return select.getColumn(0).getString();
}

std::int64_t SqliteStore::size_bytes() const {
  std::int64_t bytes = 0;
  for (const char* suffix : {"", "-wal"}) {
    std::error_code missing;
    const auto size = std::filesystem::file_size(path_ + suffix, missing);
    if (!missing) bytes += static_cast<std::int64_t>(size);
  }
  return bytes;
}

std::int64_t SqliteStore::version() const {
  return reading([&] {
    return database_.execAndGet("SELECT value FROM meta WHERE key = 'changes'").getInt64();
  });
}

std::optional<FeatureRecord> SqliteStore::features() const {
  return reading([&] { return recorded_features(); });
}

std::optional<FeatureRecord> SqliteStore::recorded_features() const {
  const char* any = "SELECT EXISTS (SELECT 1 FROM view) OR EXISTS (SELECT 1 FROM impostor)";
  if (database_.execAndGet(any).getInt() == 0) return std::nullopt;
  return FeatureRecord{meta("signature"), meta("settings")};
}

std::int64_t SqliteStore::object_id(const std::string& name) const {
  Statement select(database_, "SELECT id FROM object WHERE name = ?");
  select.bind(1, name);
  if (!select.executeStep()) fail(ErrorCode::not_found, "holds no object '" + name + "'");
  return select.getColumn(0).getInt64();
}

std::vector<ObjectSummary> SqliteStore::list() const {
  return reading([&] {
    std::vector<ObjectSummary> objects;
    Statement row(
        database_,
        "SELECT name, count(*), sum(features), min(taught_at), max(taught_at) FROM object "
        "JOIN view ON view.object = object.id GROUP BY object.id ORDER BY name");
    while (row.executeStep())
      objects.push_back({row.getColumn(0).getString(), row.getColumn(1).getInt(),
                         row.getColumn(2).getInt64(), row.getColumn(3).getString(),
                         row.getColumn(4).getString()});
    return objects;
  });
}

std::vector<ViewSummary> SqliteStore::views(const std::string& object) const {
  return reading([&] {
    std::vector<ViewSummary> views;
    Statement row(database_,
                  "SELECT number, identity, hash, yaw_deg, width, height, features, coverage, "
                  "method, source, "
                  "taught_at, version FROM view WHERE object = ? ORDER BY number");
    row.bind(1, object_id(object));
    while (row.executeStep())
      views.push_back({row.getColumn(0).getString(),
                       row.getColumn(1).getString(),
                       row.getColumn(2).getString(),
                       yaw_of(row.getColumn(3)),
                       {row.getColumn(4).getInt(), row.getColumn(5).getInt()},
                       row.getColumn(6).getInt(),
                       row.getColumn(7).getDouble(),
                       row.getColumn(8).getString(),
                       provenance_of(row)});
    return views;
  });
}

struct SqliteStore::ViewReader {
  Statement view, patch;
  std::string signature;
};

View SqliteStore::read_view(Statement& row, const std::string& signature) const {
  return checked_view([&] { return view_of(row); }, row.getColumn("identity").getString(),
                      signature, path_);
}

SqliteStore::ViewReader SqliteStore::view_reader() const {
  return {Statement(database_, "SELECT * FROM view WHERE id = ?"),
          Statement(database_, "SELECT bytes FROM patch WHERE view = ?"), meta("signature")};
}

TaughtView SqliteStore::view(const std::string& object, const std::string& id) const {
  return reading([&] {
    Statement row(database_, "SELECT * FROM view WHERE object = ? AND CAST(number AS TEXT) = ?");
    row.bind(1, object_id(object));
    row.bind(2, id);
    if (!row.executeStep())
      fail(ErrorCode::not_found, "holds no view '" + id + "' of object '" + object + "'");
    TaughtView taught;
    taught.view = read_view(row, meta("signature"));
    taught.picture = copy_of(row.getColumn("picture"));
    taught.mask = copy_of(row.getColumn("mask"));
    taught.method = row.getColumn("method").getString();
    taught.provenance = provenance_of(row);
    check_picture(taught, row.getColumn("identity").getString(), id, path_);
    return taught;
  });
}

std::shared_ptr<const View> SqliteStore::load_view(std::int64_t id, ViewReader& reader,
                                                   const LoadOptions& options) const {
  auto& [row, patch, signature] = reader;
  row.reset();
  row.bind(1, id);
  row.executeStep();
  View view = read_view(row, signature);
  patch.reset();
  patch.bind(1, id);
  const BlobView stored = patch.executeStep() ? blob_of(patch.getColumn(0)) : BlobView();
  const auto fetch = [&row = row] {
    return std::pair(copy_of(row.getColumn("picture")), copy_of(row.getColumn("mask")));
  };
  halve_descriptors(view.features);
  add_pictures(view, stored, options.pictures, fetch, path_);
  return std::make_shared<const View>(std::move(view));
}

std::vector<std::shared_ptr<const View>> SqliteStore::load_views(std::int64_t object,
                                                                 ViewReader& reader,
                                                                 const LoadOptions& options) const {
  std::vector<std::shared_ptr<const View>> views;
  Statement row(database_, "SELECT id, number, hash FROM view WHERE object = ? ORDER BY number");
  row.bind(1, object);
  while (row.executeStep()) {
    const std::string key = row.getColumn(2).getString() + '/' + row.getColumn(1).getString() +
                            (options.pictures ? " with pictures" : "");
    views.push_back(
        cache_.get(key, [&] { return load_view(row.getColumn(0).getInt64(), reader, options); }));
  }
  return views;
}

ObjectModel SqliteStore::load_object(const std::string& name, const LoadOptions& options) const {
  return reading([&] {
    ViewReader reader = view_reader();
    return ObjectModel{name, load_views(object_id(name), reader, options)};
  });
}

std::shared_ptr<const ModelSet> SqliteStore::load(const LoadOptions& options) const {
  return reading([&]() -> std::shared_ptr<const ModelSet> {
    cache_.tidy();
    const auto features = recorded_features();
    if (!features) return std::make_shared<const ModelSet>();
    std::vector<ObjectModel> objects;
    ViewReader reader = view_reader();
    Statement object(database_, "SELECT id, name FROM object ORDER BY name");
    while (object.executeStep())
      objects.push_back({object.getColumn(1).getString(),
                         load_views(object.getColumn(0).getInt64(), reader, options)});
    std::vector<Features> impostors;
    Statement row(database_, "SELECT keypoints, descriptors, dimension FROM impostor ORDER BY id");
    while (row.executeStep()) impostors.push_back(features_of(row));
    return std::make_shared<const ModelSet>(features->signature, std::move(objects),
                                            std::move(impostors));
  });
}

std::vector<ImpostorSummary> SqliteStore::impostors() const {
  return reading([&] {
    std::vector<ImpostorSummary> impostors;
    Statement row(
        database_,
        "SELECT id, identity, features, source, taught_at, version FROM impostor ORDER BY id");
    while (row.executeStep())
      impostors.push_back({row.getColumn(0).getString(), row.getColumn(1).getString(),
                           row.getColumn(2).getInt(), provenance_of(row)});
    return impostors;
  });
}

Impostor SqliteStore::impostor(const std::string& id) const {
  return reading([&] {
    Statement row(database_, "SELECT * FROM impostor WHERE CAST(id AS TEXT) = ?");
    row.bind(1, id);
    if (!row.executeStep()) fail(ErrorCode::not_found, "holds no impostor '" + id + "'");
    return Impostor{id, features_of(row), copy_of(row.getColumn("picture")), provenance_of(row)};
  });
}

std::string SqliteStore::note(const std::string& key) const {
  return reading([&]() -> std::string {
    Statement row(database_, "SELECT value FROM meta WHERE key = ?");
    row.bind(1, note_prefix + key);
    return row.executeStep() ? row.getColumn(0).getString() : "";
  });
}

Derived SqliteStore::derived(const std::string& key) const {
  return reading([&]() -> Derived {
    Statement row(database_, "SELECT version, bytes FROM derived WHERE key = ?");
    row.bind(1, key);
    if (!row.executeStep()) return {};
    return {row.getColumn(0).getInt64(), row.getColumn(1).getString()};
  });
}

}  // namespace sqlite

std::unique_ptr<ObjectStore> open_sqlite_store(const std::string& path,
                                               const SqliteOptions& options) {
  return std::make_unique<sqlite::SqliteStore>(path, options);
}

}  // namespace posevote
