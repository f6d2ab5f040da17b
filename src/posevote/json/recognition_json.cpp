#include "posevote/json/recognition_json.hpp"

#include <cmath>

namespace posevote {
namespace {

double rounded(double value, double steps_per_unit) {
  return std::round(value * steps_per_unit) / steps_per_unit;
}

double pixel(double value) {
  return rounded(value, 100);
}
double milliseconds(double value) {
  return rounded(value, 1000);
}
double share(double value) {
  return rounded(value, 1e6);
}

Json times(const StageTimes& time) {
  return {{"detect", milliseconds(time.detect)},
          {"match", milliseconds(time.match)},
          {"vote", milliseconds(time.vote)},
          {"verify", milliseconds(time.verify)},
          {"total", milliseconds(time.total)}};
}

Json rows(const cv::Matx33d& matrix) {
  Json all = Json::array();
  for (int y = 0; y < 3; ++y) all.push_back({matrix(y, 0), matrix(y, 1), matrix(y, 2)});
  return all;
}

Json box_json(const cv::Rect2f& box) {
  return {pixel(box.x), pixel(box.y), pixel(box.width), pixel(box.height)};
}

}  // namespace

Json to_json(const Detection& detection) {
  Json outline = Json::array();
  for (const cv::Point2f& point : detection.outline)
    outline.push_back({pixel(point.x), pixel(point.y)});
  Json json{{"object", detection.object},
            {"view", detection.view},
            {"confidence", share(detection.confidence)},
            {"probability", share(detection.probability)},
            {"log10_false_alarms", rounded(detection.log10_false_alarms, 100)},
            {"inliers", detection.inliers},
            {"features_in_area", detection.features_in_area},
            {"homography", rows(detection.scene_from_view)},
            {"outline", std::move(outline)},
            {"box", box_json(detection.box)}};
  if (!detection.alternatives.empty()) json["alternatives"] = detection.alternatives;
  return json;
}

Json to_json(const RecognitionResult& result, const std::string& image) {
  Json detections = Json::array();
  for (const Detection& detection : result.detections) detections.push_back(to_json(detection));
  Json json{{"image", image},
            {"width", result.image_size.width},
            {"height", result.image_size.height},
            {"time_ms", times(result.time_ms)},
            {"counts",
             {{"features", result.counts.features},
              {"matched", result.counts.matched},
              {"clustered", result.counts.clustered},
              {"verified", result.counts.verified}}},
            {"detections", std::move(detections)}};
  if (result.incomplete) json["incomplete"] = true;
  for (const UnknownRegion& region : result.unknown)
    json["unknown"].push_back({{"box", box_json(region.box)}, {"features", region.features}});
  return json;
}

Json to_json(const Explanation& explanation) {
  const Explanation& e = explanation;
  Json json{{"object", e.object},    {"found", e.found},     {"stage", e.stage},
            {"reason", e.reason},    {"option", e.option},   {"scene_features", e.scene_features},
            {"similar", e.similar},  {"matched", e.matched}, {"largest_bin", e.largest_bin},
            {"clusters", e.clusters}};
  if (e.best) json["best"] = to_json(*e.best);
  return json;
}

Json error_json(const std::string& image, const std::string& error) {
  return {{"image", image}, {"error", error}};
}

std::string to_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace posevote
