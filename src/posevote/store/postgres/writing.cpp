#include "posevote/core/error.hpp"
#include "posevote/store/object_name.hpp"
#include "posevote/store/postgres/postgres_store_impl.hpp"
#include "posevote/store/postgres/rows.hpp"
#include "posevote/store/postgres/schema.hpp"

namespace posevote::postgres {
namespace {

const char* yaw_or_null(double yaw_deg, std::string& text) {
  if (std::isnan(yaw_deg)) return nullptr;
  text = number_text(yaw_deg);
  return text.c_str();
}

std::string time_of(const Provenance& provenance) {
  return provenance.taught_at.empty() ? utc_now() : provenance.taught_at;
}

}  // namespace

void PostgresStore::transact(const std::function<void()>& work) {
  const std::lock_guard lock(mutex_);
  guarded(location_, address_, [&] {
    if (work_) return work();
    if (options_.access == Access::read_only)
      fail(ErrorCode::io, "cannot be changed: it was opened for reading only");
    revive();
    try {
      pqxx::work transaction(link().connection);
      const Current current(work_, transaction);
      transaction.exec0("SET LOCAL lock_timeout = " + std::to_string(options_.busy_timeout_ms));
      transaction.exec(writer_lock);
      work();
      transaction.commit();
    } catch (const pqxx::pqxx_exception&) {
      if (!link_->connection.is_open()) link_.reset();
      throw;
    }
  });
}

void PostgresStore::record(const FeatureRecord& features) {
  work_->exec_params(
      "INSERT INTO posevote.features (signature, settings) VALUES ($1, $2) ON CONFLICT (one) DO "
      "UPDATE SET signature = excluded.signature, settings = excluded.settings",
      features.signature, features.settings);
}

void PostgresStore::require_features(const FeatureRecord& features) {
  const auto present = recorded_features();
  if (!present) return record(features);
  if (present->signature != features.signature)
    fail(ErrorCode::feature_mismatch, why_not_mixed(*present, features));
}

AddResult PostgresStore::add_view(const std::string& object, const TaughtView& view,
                                  const FeatureRecord& features) {
  check_object_name(object);
  const TaughtView complete = complete_view(view);
  const std::string identity = identity_hash(complete);
  AddResult result;
  transact([&] {
    require_features(features);
    work_->exec_params("INSERT INTO posevote.object (name) VALUES ($1) ON CONFLICT DO NOTHING",
                       object);
    const std::int64_t id = object_id(object);
    const auto same = work_->exec_params(
        "SELECT number FROM posevote.view WHERE object = $1 AND identity = $2", id, identity);
    if (!same.empty())
      result = {same[0][0].c_str(), false};
    else
      result = {insert_view(id, complete, identity, features.signature), true};
  });
  return result;
}

std::string PostgresStore::insert_view(std::int64_t object, const TaughtView& taught,
                                       const std::string& identity, const std::string& signature) {
  const View& view = taught.view;
  const auto number = work_->exec_params1(
      "UPDATE posevote.object SET next_number = next_number + 1 WHERE id = $1 RETURNING "
      "next_number - 1",
      object);
  std::string yaw;
  work_->exec_params0(
      "INSERT INTO posevote.view (object, number, identity, hash, yaw_deg, width, height, "
      "centre_x, centre_y, coverage, features, dimension, method, source, taught_at, version, "
      "outline, keypoints, descriptors, mask, picture, patch) VALUES ($1, $2, $3, $4, $5, $6, $7, "
      "$8, $9, $10, $11, $12, $13, $14, $15, $16, $17, $18, $19, $20, $21, $22)",
      object, number[0].c_str(), identity, content_hash(view, identity, signature),
      yaw_or_null(view.yaw_deg, yaw), view.image_size.width, view.image_size.height,
      number_text(view.centre.x), number_text(view.centre.y), number_text(coverage(view)),
      view.features.size(), view.features.descriptors.cols, taught.method, taught.provenance.source,
      time_of(taught.provenance), taught.provenance.version, bytes(encode_points(view.outline)),
      bytes(encode_keypoints(view.features)), bytes(encode_descriptors(view.features)),
      bytes(taught.mask), bytes(taught.picture),
      bytes(patch_blob(view, taught.picture, taught.mask)));
  return number[0].c_str();
}

void PostgresStore::remove_object(const std::string& name) {
  transact(
      [&] { work_->exec_params("DELETE FROM posevote.object WHERE id = $1", object_id(name)); });
}

void PostgresStore::remove_view(const std::string& object, const std::string& id) {
  transact([&] {
    const std::int64_t row = object_id(object);
    const auto removed = work_->exec_params(
        "DELETE FROM posevote.view WHERE object = $1 AND number::text = $2", row, id);
    if (removed.affected_rows() == 0)
      fail(ErrorCode::not_found, "holds no view '" + id + "' of object '" + object + "'");
    work_->exec_params(
        "DELETE FROM posevote.object WHERE id = $1 AND NOT EXISTS (SELECT 1 FROM posevote.view "
        "WHERE object = $1)",
        row);
  });
}

void PostgresStore::rename_object(const std::string& from, const std::string& to) {
  check_object_name(to);
  transact([&] {
    const std::int64_t id = object_id(from);
    if (!work_->exec_params("SELECT 1 FROM posevote.object WHERE name = $1 AND id <> $2", to, id)
             .empty())
      fail(ErrorCode::already_exists, "holds an object '" + to + "' already");
    work_->exec_params("UPDATE posevote.object SET name = $1 WHERE id = $2", to, id);
  });
}

AddResult PostgresStore::add_impostor(const Impostor& impostor, const FeatureRecord& features) {
  const std::string identity = identity_hash(impostor);
  AddResult result;
  transact([&] {
    require_features(features);
    const auto added = work_->exec_params(
        "INSERT INTO posevote.impostor (identity, features, dimension, source, taught_at, version, "
        "keypoints, descriptors, picture) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9) ON CONFLICT "
        "DO NOTHING",
        identity, impostor.features.size(), impostor.features.descriptors.cols,
        impostor.provenance.source, time_of(impostor.provenance), impostor.provenance.version,
        bytes(encode_keypoints(impostor.features)), bytes(encode_descriptors(impostor.features)),
        bytes(impostor.picture));
    result.added = added.affected_rows() != 0;
    result.id =
        work_->exec_params1("SELECT id FROM posevote.impostor WHERE identity = $1", identity)[0]
            .c_str();
  });
  return result;
}

void PostgresStore::remove_impostor(const std::string& id) {
  transact([&] {
    const auto removed =
        work_->exec_params("DELETE FROM posevote.impostor WHERE id::text = $1", id);
    if (removed.affected_rows() == 0) fail(ErrorCode::not_found, "holds no impostor '" + id + "'");
  });
}

void PostgresStore::set_note(const std::string& key, const std::string& text) {
  transact([&] {
    work_->exec_params0(
        "INSERT INTO posevote.note VALUES ($1, $2) ON CONFLICT (key) DO UPDATE SET text = "
        "excluded.text",
        key, text);
  });
}

void PostgresStore::set_derived(const std::string& key, const Derived& derived) {
  transact([&] {
    work_->exec_params0(
        "INSERT INTO posevote.derived VALUES ($1, $2, $3) ON CONFLICT (key) DO UPDATE SET version "
        "= excluded.version, bytes = excluded.bytes",
        key, derived.version, pqxx::binarystring(derived.bytes));
  });
}

void PostgresStore::rebuild(const FeatureRecord& features, const FeatureMaker& maker) {
  transact([&] {
    for (const pqxx::row row : work_->exec("SELECT id FROM posevote.view ORDER BY id"))
      rebuild_view(row[0].as<std::int64_t>(), features, maker);
    for (const pqxx::row row : work_->exec("SELECT id FROM posevote.impostor ORDER BY id"))
      rebuild_impostor(row[0].as<std::int64_t>(), maker);
    record(features);
  });
}

void PostgresStore::rebuild_view(std::int64_t id, const FeatureRecord& features,
                                 const FeatureMaker& maker) {
  const pqxx::row row = work_->exec_params1(
      "SELECT number, identity, yaw_deg, width, height, centre_x, centre_y, outline, picture, mask "
      "FROM posevote.view WHERE id = $1",
      id);
  TaughtView taught;
  View& view = taught.view;
  taught.picture = blob_of(row["picture"]);
  taught.mask = blob_of(row["mask"]);
  view.yaw_deg = yaw_of(row["yaw_deg"]);
  const std::string identity = row["identity"].c_str();
  check_picture(taught, identity, row["number"].c_str(), location_);
  view.image_size = {row["width"].as<int>(), row["height"].as<int>()};
  const Blob outline = blob_of(row["outline"]);
  view.outline = decode_points({outline.data(), outline.size()});
  view.centre = {static_cast<float>(row["centre_x"].as<double>()),
                 static_cast<float>(row["centre_y"].as<double>())};
  view.features = maker(taught.picture, taught.mask);
  check_features(view.features);
  work_->exec_params0(
      "UPDATE posevote.view SET hash = $2, features = $3, dimension = $4, keypoints = $5, "
      "descriptors = $6, patch = $7 WHERE id = $1",
      id, content_hash(view, identity, features.signature), view.features.size(),
      view.features.descriptors.cols, bytes(encode_keypoints(view.features)),
      bytes(encode_descriptors(view.features)),
      bytes(patch_blob(view, taught.picture, taught.mask)));
}

void PostgresStore::rebuild_impostor(std::int64_t id, const FeatureMaker& maker) {
  const pqxx::row row =
      work_->exec_params1("SELECT picture FROM posevote.impostor WHERE id = $1", id);
  const Features features = maker(blob_of(row[0]), {});
  check_features(features);
  work_->exec_params0(
      "UPDATE posevote.impostor SET features = $2, dimension = $3, keypoints = $4, descriptors = "
      "$5 WHERE id = $1",
      id, features.size(), features.descriptors.cols, bytes(encode_keypoints(features)),
      bytes(encode_descriptors(features)));
}

}  // namespace posevote::postgres
