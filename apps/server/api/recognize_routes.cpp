// /api/recognize, /api/explain and /api/impostors: pictures that are sent, detections that are
// wrong.
#include <algorithm>

#include "api/routes.hpp"
#include "http/problem.hpp"
#include "json.hpp"
#include "posevote/recognize/explain.hpp"
#include "posevote/recognize/trace.hpp"
#include "posevote/render/annotate.hpp"
#include "posevote/render/draw_explanation.hpp"
#include "posevote/teach/segment.hpp"
#include "studio/pictures.hpp"

namespace posevote::server {
namespace {

bool wants_jpeg(const Request& request) {
  const std::string format = request.find("format").value_or("json");
  if (format != "json" && format != "jpeg") throw invalid("format must be json or jpeg");
  return format == "jpeg";
}

Response recognize(const Request& request, Studio& studio) {
  const bool jpeg = wants_jpeg(request);
  Body body = request.read_body(most_bytes(studio.limits.body_mb));
  const JobSlots::Slot slot(studio.jobs);
  const SentPicture picture = decode_sent(take_picture(body), studio.limits);
  const cv::Mat image = to_bgr8(picture.image);
  const RecognitionResult result = studio.catalogue.recognizer()->recognize(image);
  studio.metrics.count_recognition(result, false);
  if (jpeg) return bytes_response("image/jpeg", encode_jpeg(annotate(image, result), 90));
  return json_response(to_json(result, picture.source));
}

/// The picture that is meant: a frame of which there was a result, or the one that is sent.
SentPicture meant_picture(const Request& request, Body body, const Studio& studio) {
  const auto number = parse_number(request, "frame", 0, 1e15);
  if (!number) return decode_sent(take_picture(body), studio.limits);
  const auto frame = studio.live.recent(static_cast<std::int64_t>(*number));
  if (!frame) throw not_found("this frame is not kept any more; choose a newer detection");
  SentPicture picture;
  picture.image = frame->image();
  picture.source = frame->source();
  return picture;
}

/// As the library gives it, its option by the name that it has in the settings.
Json explanation_json(const Explanation& explanation) {
  Json json = to_json(explanation);
  if (!explanation.option.empty()) json["option"] = "recognize." + explanation.option;
  return json;
}

Response explain_picture(const Request& request, Studio& studio) {
  const bool jpeg = wants_jpeg(request);
  const auto object = request.find("object");
  if (jpeg && !object) throw invalid("a picture explains one object: name it as object=NAME");
  Body body = request.read_body(most_bytes(studio.limits.body_mb));
  const JobSlots::Slot slot(studio.jobs);
  const SentPicture picture = meant_picture(request, std::move(body), studio);
  const cv::Mat image = to_bgr8(picture.image);
  const auto recognizer = studio.catalogue.recognizer();
  if (jpeg)
    return bytes_response(
        "image/jpeg",
        encode_jpeg(draw_explanation(image, explain(*recognizer, image, *object)), 90));
  const Trace trace = recognizer->trace(image);
  Json list = Json::array();
  for (const ObjectModel& known : trace.models->objects())
    if (!object || known.name == *object)
      list.push_back(explanation_json(explain(trace, recognizer->options(), known.name)));
  if (object && list.empty()) throw not_found("there is no object '" + *object + "'");
  return json_response({{"image", picture.source},
                        {"width", image.cols},
                        {"height", image.rows},
                        {"explanations", std::move(list)}});
}

ImpostorSummary find_impostor(const Studio& studio, const std::string& id) {
  const auto all = studio.catalogue.store().impostors();
  const auto at = std::ranges::find(all, id, &ImpostorSummary::id);
  if (at == all.end()) throw not_found("there is no impostor '" + id + "'");
  return *at;
}

Response add_impostor(const Request& request, Studio& studio) {
  const auto box = parse_rectangle(request, "box");
  Body body = request.read_body(most_bytes(studio.limits.body_mb));
  const JobSlots::Slot slot(studio.jobs);
  const SentPicture picture = meant_picture(request, std::move(body), studio);
  const cv::Mat frame = to_bgr8(picture.image);
  cv::Rect inside({}, frame.size());
  if (box) inside &= *box;
  if (inside.empty()) throw invalid("the box lies outside the picture");
  cv::Mat mask(frame.size(), CV_8U, cv::Scalar(0));
  mask(inside) = 255;
  const FeatureOptions features = studio.catalogue.features();
  Impostor impostor;
  impostor.picture = encode_png(frame(inside));
  // Of the whole frame, so that they are the very features that matched.
  impostor.features = make_extractor(features)->extract(frame, mask);
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
  add("POST", "/api/explain",
      [](Request& request, Studio& s) { return explain_picture(request, s); });
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
    return picture_response(request, s.catalogue.store().impostor(request["impostor"]).picture,
                            s.jobs, s.limits);
  });
}

}  // namespace posevote::server
