#include "json.hpp"

#include <cmath>

#include "http/problem.hpp"

namespace posevote::server {

Response json_response(const Json& json, int status) {
  Response response;
  response.status = status;
  response.type = "application/json";
  response.body = to_line(json);
  return response;
}

Json read_json(const Request& request) {
  constexpr std::size_t kMostBytes = 100'000;
  const Body body = request.read_body(kMostBytes);
  Json json = Json::parse(body.raw.begin(), body.raw.end(), nullptr, false);
  if (!json.is_object()) throw invalid("the request's body must be a JSON object");
  return json;
}

std::string text_of(const Json& json, const char* name) {
  const auto at = json.find(name);
  if (at == json.end() || !at->is_string())
    throw invalid(std::string("the request's body must have a text \"") + name + "\"");
  return at->get<std::string>();
}

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json points_json(const std::vector<cv::Point2f>& points) {
  Json json = Json::array();
  for (const cv::Point2f& point : points)
    json.push_back({std::round(point.x * 100) / 100, std::round(point.y * 100) / 100});
  return json;
}

Json object_json(const ObjectSummary& object) {
  return {{"object", object.name},
          {"views", object.views},
          {"features", object.features},
          {"first_taught_at", object.first_taught_at},
          {"last_taught_at", object.last_taught_at}};
}

Json view_json(const ViewSummary& view) {
  return {{"view", view.id},
          {"yaw", number_or_null(view.yaw_deg)},
          {"width", view.image_size.width},
          {"height", view.image_size.height},
          {"features", view.features},
          {"coverage", view.coverage},
          {"method", view.method},
          {"source", view.provenance.source},
          {"taught_at", view.provenance.taught_at}};
}

Json quality_json(const ViewQuality& quality) {
  return {{"features", quality.features},
          {"coverage", quality.coverage},
          {"self_similarity", number_or_null(quality.self_similarity)},
          {"size_px", quality.size_px},
          {"smallest_size_px", number_or_null(quality.smallest_size_px)},
          {"redundancy", quality.redundancy},
          {"next_yaw", number_or_null(quality.next_yaw_deg)},
          {"advice", quality.advice}};
}

Json impostor_json(const ImpostorSummary& impostor) {
  return {{"impostor", impostor.id},
          {"features", impostor.features},
          {"source", impostor.provenance.source},
          {"taught_at", impostor.provenance.taught_at}};
}

Json next_yaw_json(const std::vector<ViewSummary>& views) {
  std::vector<double> yaws;
  for (const ViewSummary& view : views)
    if (std::isfinite(view.yaw_deg)) yaws.push_back(view.yaw_deg);
  return yaws.empty() ? Json() : number_or_null(next_yaw(yaws, QualityOptions().max_gap_deg));
}

}  // namespace posevote::server
