#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>

#include "posevote/core/error.hpp"
#include "posevote/store/object_name.hpp"
#include "posevote/store/sqlite/rows.hpp"
#include "posevote/store/sqlite/sqlite_store_impl.hpp"

namespace posevote::sqlite {

using SQLite::Statement;

void SqliteStore::transact(const std::function<void()>& work) {
  const std::lock_guard lock(mutex_);
  guarded(path_, [&] {
    if (writing_) return work();
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    struct Flag {
      bool& flag;
      explicit Flag(bool& f) : flag(f) { flag = true; }
      ~Flag() { flag = false; }
    } const writing(writing_);
    const int before = database_.getTotalChanges();
    work();
    if (database_.getTotalChanges() != before)
      database_.exec("UPDATE meta SET value = value + 1 WHERE key = 'changes'");
    transaction.commit();
  });
}

void SqliteStore::record(const FeatureRecord& features) {
  Statement insert(database_,
                   "INSERT OR REPLACE INTO meta VALUES ('signature', ?), ('settings', ?)");
  insert.bind(1, features.signature);
  insert.bind(2, features.settings);
  insert.exec();
}

void SqliteStore::require_features(const FeatureRecord& features) {
  const auto present = recorded_features();
  if (!present) return record(features);
  if (present->signature != features.signature)
    fail(ErrorCode::feature_mismatch, why_not_mixed(*present, features));
}

AddResult SqliteStore::add_view(const std::string& object, const TaughtView& view,
                                const FeatureRecord& features) {
  check_object_name(object);
  const TaughtView complete = complete_view(view);
  const std::string identity = identity_hash(complete);
  AddResult result;
  transact([&] {
    require_features(features);
    Statement make(database_, "INSERT OR IGNORE INTO object (name) VALUES (?)");
    make.bind(1, object);
    make.exec();
    const std::int64_t id = object_id(object);
    Statement same(database_, "SELECT number FROM view WHERE object = ? AND identity = ?");
    same.bind(1, id);
    same.bind(2, identity);
    if (same.executeStep())
      result = {same.getColumn(0).getString(), false};
    else
      result = {insert_view(id, complete, identity, features.signature), true};
  });
  return result;
}

std::string SqliteStore::insert_view(std::int64_t object, const TaughtView& view,
                                     const std::string& identity, const std::string& signature) {
  Statement take(database_,
                 "UPDATE object SET next_number = next_number + 1 WHERE id = ? "
                 "RETURNING next_number - 1");
  take.bind(1, object);
  take.executeStep();
  const std::int64_t number = take.getColumn(0).getInt64();
  take.reset();
  Statement insert(
      database_,
      "INSERT INTO view (object, number, identity, hash, yaw_deg, width, height, centre_x, "
      "centre_y, coverage, features, dimension, method, source, taught_at, version, outline, "
      "keypoints, descriptors, mask, picture) VALUES (:object, :number, :identity, :hash, "
      ":yaw_deg, "
      ":width, :height, :centre_x, :centre_y, :coverage, :features, :dimension, :method, :source, "
      ":taught_at, :version, :outline, :keypoints, :descriptors, :mask, :picture)");
  insert.bind(":object", object);
  insert.bind(":number", number);
  insert.bind(":identity", identity);
  insert.bind(":hash", content_hash(view.view, identity, signature));
  insert.bind(":method", view.method);
  bind_view(insert, view.view);
  bind_provenance(insert, view.provenance);
  bind_blob(insert, ":mask", view.mask);
  bind_blob(insert, ":picture", view.picture);
  insert.exec();
  keep_patch(database_.getLastInsertRowid(), patch_blob(view.view, view.picture, view.mask));
  return std::to_string(number);
}

void SqliteStore::keep_patch(std::int64_t view, const Blob& patch) {
  Statement insert(database_, "INSERT OR REPLACE INTO patch (view, bytes) VALUES (:view, :bytes)");
  insert.bind(":view", view);
  bind_blob(insert, ":bytes", patch);
  insert.exec();
}

void SqliteStore::remove_object(const std::string& name) {
  transact([&] {
    Statement remove(database_, "DELETE FROM object WHERE id = ?");
    remove.bind(1, object_id(name));
    remove.exec();
  });
}

void SqliteStore::remove_view(const std::string& object, const std::string& id) {
  transact([&] {
    const std::int64_t row = object_id(object);
    Statement remove(database_, "DELETE FROM view WHERE object = ? AND CAST(number AS TEXT) = ?");
    remove.bind(1, row);
    remove.bind(2, id);
    if (remove.exec() == 0)
      fail(ErrorCode::not_found, "holds no view '" + id + "' of object '" + object + "'");
    Statement tidy(database_,
                   "DELETE FROM object WHERE id = ? AND id NOT IN (SELECT object FROM view)");
    tidy.bind(1, row);
    tidy.exec();
  });
}

void SqliteStore::rename_object(const std::string& from, const std::string& to) {
  check_object_name(to);
  transact([&] {
    const std::int64_t id = object_id(from);
    Statement taken(database_, "SELECT 1 FROM object WHERE name = ? AND id <> ?");
    taken.bind(1, to);
    taken.bind(2, id);
    if (taken.executeStep())
      fail(ErrorCode::already_exists, "holds an object '" + to + "' already");
    Statement rename(database_, "UPDATE object SET name = ? WHERE id = ?");
    rename.bind(1, to);
    rename.bind(2, id);
    rename.exec();
  });
}

AddResult SqliteStore::add_impostor(const Impostor& impostor, const FeatureRecord& features) {
  const std::string identity = identity_hash(impostor);
  AddResult result;
  transact([&] {
    require_features(features);
    Statement insert(database_,
                     "INSERT OR IGNORE INTO impostor (identity, features, dimension, source, "
                     "taught_at, version, keypoints, descriptors, picture) VALUES (:identity, "
                     ":features, :dimension, :source, :taught_at, :version, :keypoints, "
                     ":descriptors, :picture)");
    insert.bind(":identity", identity);
    bind_features(insert, impostor.features);
    bind_provenance(insert, impostor.provenance);
    bind_blob(insert, ":picture", impostor.picture);
    result.added = insert.exec() != 0;
    Statement select(database_, "SELECT id FROM impostor WHERE identity = ?");
    select.bind(1, identity);
    select.executeStep();
    result.id = select.getColumn(0).getString();
  });
  return result;
}

void SqliteStore::remove_impostor(const std::string& id) {
  transact([&] {
    Statement remove(database_, "DELETE FROM impostor WHERE CAST(id AS TEXT) = ?");
    remove.bind(1, id);
    if (remove.exec() == 0) fail(ErrorCode::not_found, "holds no impostor '" + id + "'");
  });
}

void SqliteStore::set_note(const std::string& key, const std::string& text) {
  transact([&] {
    Statement insert(database_, "INSERT OR REPLACE INTO meta VALUES (?, ?)");
    insert.bind(1, note_prefix + key);
    insert.bind(2, text);
    insert.exec();
  });
}

void SqliteStore::set_derived(const std::string& key, const Derived& derived) {
  const std::lock_guard lock(mutex_);
  guarded(path_, [&] {
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    Statement insert(database_, "INSERT OR REPLACE INTO derived VALUES (?, ?, ?)");
    insert.bind(1, key);
    insert.bind(2, derived.version);
    insert.bindNoCopy(3, derived.bytes.data(), static_cast<int>(derived.bytes.size()));
    insert.exec();
    transaction.commit();
  });
}

std::vector<std::int64_t> SqliteStore::row_ids(const std::string& table) const {
  std::vector<std::int64_t> ids;
  Statement row(database_, "SELECT id FROM " + table + " ORDER BY id");
  while (row.executeStep()) ids.push_back(row.getColumn(0).getInt64());
  return ids;
}

void SqliteStore::rebuild(const FeatureRecord& features, const FeatureMaker& maker) {
  transact([&] {
    for (const std::int64_t id : row_ids("view")) rebuild_view(id, features, maker);
    for (const std::int64_t id : row_ids("impostor")) rebuild_impostor(id, maker);
    record(features);
  });
}

void SqliteStore::rebuild_view(std::int64_t id, const FeatureRecord& features,
                               const FeatureMaker& maker) {
  Statement row(database_, "SELECT * FROM view WHERE id = ?");
  row.bind(1, id);
  row.executeStep();
  TaughtView taught;
  View& view = taught.view;
  taught.picture = copy_of(row.getColumn("picture"));
  taught.mask = copy_of(row.getColumn("mask"));
  view.yaw_deg = yaw_of(row.getColumn("yaw_deg"));
  const std::string identity = row.getColumn("identity").getString();
  check_picture(taught, identity, row.getColumn("number").getString(), path_);
  view.image_size = {row.getColumn("width").getInt(), row.getColumn("height").getInt()};
  view.outline = decode_points(blob_of(row.getColumn("outline")));
  view.centre = {static_cast<float>(row.getColumn("centre_x").getDouble()),
                 static_cast<float>(row.getColumn("centre_y").getDouble())};
  view.features = maker(taught.picture, taught.mask);
  check_features(view.features);
  Statement update(database_,
                   "UPDATE view SET hash = :hash, features = :features, dimension = :dimension, "
                   "keypoints = :keypoints, descriptors = :descriptors WHERE id = :id");
  update.bind(":id", id);
  update.bind(":hash", content_hash(view, identity, features.signature));
  bind_features(update, view.features);
  row.reset();
  update.exec();
  keep_patch(id, patch_blob(view, taught.picture, taught.mask));
}

void SqliteStore::rebuild_impostor(std::int64_t id, const FeatureMaker& maker) {
  Statement row(database_, "SELECT picture FROM impostor WHERE id = ?");
  row.bind(1, id);
  row.executeStep();
  const Features features = maker(copy_of(row.getColumn(0)), {});
  check_features(features);
  row.reset();
  Statement update(database_,
                   "UPDATE impostor SET features = :features, dimension = :dimension, "
                   "keypoints = :keypoints, descriptors = :descriptors WHERE id = :id");
  update.bind(":id", id);
  bind_features(update, features);
  update.exec();
}

}  // namespace posevote::sqlite
