#include "posevote/store/postgres/rows.hpp"

#include <charconv>

namespace posevote::postgres {
namespace {

cv::Point2f point_of(const pqxx::row& row, const char* x, const char* y) {
  return {static_cast<float>(row[x].as<double>()), static_cast<float>(row[y].as<double>())};
}

BlobView view_of(const Blob& blob) {
  return {blob.data(), blob.size()};
}

}  // namespace

Blob blob_of(const pqxx::field& field) {
  const pqxx::binarystring raw(field);
  return {raw.begin(), raw.end()};
}

pqxx::binarystring bytes(const Blob& blob) {
  return {blob.empty() ? static_cast<const void*>("") : blob.data(), blob.size()};
}

std::string number_text(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

Provenance provenance_of(const pqxx::row& row) {
  return {row["source"].c_str(), row["taught_at"].c_str(), row["version"].c_str()};
}

Features features_of(const pqxx::row& row) {
  const Blob keypoints = blob_of(row["keypoints"]), descriptors = blob_of(row["descriptors"]);
  return decode_features(view_of(keypoints), view_of(descriptors), row["dimension"].as<int>());
}

double yaw_of(const pqxx::field& field) {
  return field.is_null() ? std::nan("") : field.as<double>();
}

View view_of(const pqxx::row& row) {
  View view;
  view.id = row["number"].c_str();
  view.hash = row["hash"].c_str();
  view.yaw_deg = yaw_of(row["yaw_deg"]);
  view.image_size = {row["width"].as<int>(), row["height"].as<int>()};
  view.centre = point_of(row, "centre_x", "centre_y");
  const Blob outline = blob_of(row["outline"]);
  view.outline = decode_points(view_of(outline));
  view.features = features_of(row);
  return view;
}

}  // namespace posevote::postgres
