// /api/recognize and /api/impostors: pictures that are sent, detections that are wrong.
#include <algorithm>

#include "api/routes.hpp"
#include "http/problem.hpp"
#include "json.hpp"
#include "posevote/render/annotate.hpp"
#include "posevote/teach/segment.hpp"
#include "studio/pictures.hpp"

namespace posevote::server {
namespace {

Response recognize(const Request& request, Studio& studio) {
  const std::string format = request.find("format").value_or("json");
  if (format != "json" && format != "jpeg") throw invalid("format must be json or jpeg");
  Body body = request.read_body(most_bytes(studio.limits.body_mb));
  const JobSlots::Slot slot(studio.jobs);
  const SentPicture picture = decode_sent(take_picture(body), studio.limits);
  const cv::Mat image = to_bgr8(picture.image);
  const RecognitionResult result = studio.catalogue.recognizer()->recognize(image);
  studio.metrics.count_recognition(result, false);
  if (format == "jpeg")
    return bytes_response("image/jpeg", encode_jpeg(annotate(image, result), 90));
  return json_response(to_json(result, picture.source));
}

/// The picture that is meant: a frame of which there was a result, or the one that is sent.
SentPicture meant_picture(const Request& request, Studio& studio) {
  Body body = request.read_body(most_bytes(studio.limits.body_mb));
  const auto number = parse_number(request, "frame", 0, 1e15);
  if (!number) return decode_sent(take_picture(body), studio.limits);
  const auto frame = studio.live.recent(static_cast<std::int64_t>(*number));
  if (!frame) throw not_found("this frame is not kept any more; choose a newer detection");
  SentPicture picture;
  picture.image = frame->image();
  picture.source = frame->source();
  return picture;
}

ImpostorSummary find_impostor(const Studio& studio, const std::string& id) {
  const auto all = studio.catalogue.store().impostors();
  const auto at = std::ranges::find(all, id, &ImpostorSummary::id);
  if (at == all.end()) throw not_found("there is no impostor '" + id + "'");
  return *at;
}

Response add_impostor(const Request& request, Studio& studio) {
  const auto box = parse_rectangle(request, "box");
  const JobSlots::Slot slot(studio.jobs);
  const SentPicture picture = meant_picture(request, studio);
  cv::Mat area = to_bgr8(picture.image);
  if (box) {
    const cv::Rect inside = *box & cv::Rect({}, area.size());
    if (inside.empty()) throw invalid("the box lies outside the picture");
    area = area(inside).clone();
  }
  const FeatureOptions features = studio.catalogue.features();
  Impostor impostor;
  impostor.picture = encode_png(area);
  impostor.features = make_extractor(features)->extract(area);
  impostor.provenance = {picture.source, "", studio.version};
  const AddResult result =
      studio.catalogue.store().add_impostor(impostor, record_features(features));
  studio.catalogue.refresh();
  return json_response(impostor_json(find_impostor(studio, result.id)), 201);
}

}  // namespace

void add_recognize_routes(Router& router, Studio& studio) {
  const auto add = [&](const char* method, const char* path, auto handler) {
    router.add({method, path, Entry::protected_,
                [&studio, handler](Request& request) { return handler(request, studio); }});
  };
  add("POST", "/api/recognize", [](Request& request, Studio& s) { return recognize(request, s); });
  add("GET", "/api/impostors", [](Request&, Studio& s) {
    Json list = Json::array();
    for (const auto& impostor : s.catalogue.store().impostors())
      list.push_back(impostor_json(impostor));
    return json_response({{"impostors", std::move(list)}});
  });
  add("POST", "/api/impostors",
      [](Request& request, Studio& s) { return add_impostor(request, s); });
  add("DELETE", "/api/impostors/{impostor}", [](Request& request, Studio& s) {
    s.catalogue.store().remove_impostor(request["impostor"]);
    s.catalogue.refresh();
    return no_content();
  });
  add("GET", "/api/impostors/{impostor}/picture", [](Request& request, Studio& s) {
    return picture_response(request, s.catalogue.store().impostor(request["impostor"]).picture);
  });
}

}  // namespace posevote::server
