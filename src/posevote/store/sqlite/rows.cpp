#include "posevote/store/sqlite/rows.hpp"

#include "posevote/store/stored_view.hpp"

namespace posevote::sqlite {
namespace {

using SQLite::Statement;

cv::Point2f point_of(Statement& row, const char* x, const char* y) {
  return {static_cast<float>(row.getColumn(x).getDouble()),
          static_cast<float>(row.getColumn(y).getDouble())};
}

}  // namespace

BlobView blob_of(const SQLite::Column& column) {
  return {column.getBlob(), static_cast<std::size_t>(column.getBytes())};
}

Blob copy_of(const SQLite::Column& column) {
  const BlobView blob = blob_of(column);
  const auto* data = static_cast<const std::uint8_t*>(blob.data);
  return {data, data + blob.size};
}

Provenance provenance_of(Statement& row) {
  return {row.getColumn("source").getString(), row.getColumn("taught_at").getString(),
          row.getColumn("version").getString()};
}

Features features_of(Statement& row) {
  return decode_features(blob_of(row.getColumn("keypoints")), blob_of(row.getColumn("descriptors")),
                         row.getColumn("dimension").getInt());
}

double yaw_of(const SQLite::Column& column) {
  return column.isNull() ? std::nan("") : column.getDouble();
}

View view_of(Statement& row) {
  View view;
  view.id = row.getColumn("number").getString();
  view.hash = row.getColumn("hash").getString();
  view.yaw_deg = yaw_of(row.getColumn("yaw_deg"));
  view.image_size = {row.getColumn("width").getInt(), row.getColumn("height").getInt()};
  view.centre = point_of(row, "centre_x", "centre_y");
  view.outline = decode_points(blob_of(row.getColumn("outline")));
  view.features = features_of(row);
  return view;
}

void bind_blob(Statement& statement, const char* name, const Blob& blob) {
  // SQLite takes a null pointer for NULL, also when the size is 0.
  const void* data = blob.empty() ? static_cast<const void*>("") : blob.data();
  statement.bind(name, data, static_cast<int>(blob.size()));
}

void bind_provenance(Statement& statement, const Provenance& provenance) {
  statement.bind(":source", provenance.source);
  statement.bind(":taught_at", provenance.taught_at.empty() ? utc_now() : provenance.taught_at);
  statement.bind(":version", provenance.version);
}

void bind_features(Statement& statement, const Features& features) {
  statement.bind(":features", static_cast<int>(features.size()));
  statement.bind(":dimension", features.descriptors.cols);
  bind_blob(statement, ":keypoints", encode_keypoints(features));
  bind_blob(statement, ":descriptors", encode_descriptors(features));
}

void bind_view(Statement& statement, const View& view) {
  if (!std::isnan(view.yaw_deg)) statement.bind(":yaw_deg", view.yaw_deg);
  statement.bind(":width", view.image_size.width);
  statement.bind(":height", view.image_size.height);
  statement.bind(":centre_x", view.centre.x);
  statement.bind(":centre_y", view.centre.y);
  statement.bind(":coverage", coverage(view));
  bind_blob(statement, ":outline", encode_points(view.outline));
  bind_features(statement, view.features);
}

}  // namespace posevote::sqlite
