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

Json points_json(const std::vector<cv::Point2f>& points) {
  Json json = Json::array();
  for (const cv::Point2f& point : points)
    json.push_back({std::round(point.x * 100) / 100, std::round(point.y * 100) / 100});
  return json;
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

Json next_yaw_json(const std::vector<double>& yaws_deg) {
  return yaws_deg.empty() ? Json()
                          : number_or_null(next_yaw(yaws_deg, QualityOptions().max_gap_deg));
}

std::vector<double> yaws_of(const std::vector<ViewSummary>& views) {
  std::vector<double> yaws;
  for (const ViewSummary& view : views)
    if (std::isfinite(view.yaw_deg)) yaws.push_back(view.yaw_deg);
  return yaws;
}

}  // namespace posevote::server
