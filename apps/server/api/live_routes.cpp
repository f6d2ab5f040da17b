// /api/live, /api/frame.jpg, /api/source: the camera as it is now.
#include "api/routes.hpp"
#include "http/problem.hpp"
#include "json.hpp"
#include "posevote/teach/segment.hpp"
#include "studio/pictures.hpp"

namespace posevote::server {
namespace {

const char* name_of(CameraState state) {
  switch (state) {
    case CameraState::waiting:
      return "waiting";
    case CameraState::running:
      return "running";
    case CameraState::lost:
      break;
  }
  return "lost";
}

Json source_json(const Studio& studio) {
  return {{"source", studio.camera.status().source}, {"choices", studio.camera.choices()}};
}

Response get_frame(const Request& request, const Studio& studio) {
  std::shared_ptr<const LiveFrame> frame;
  if (const auto number = parse_number(request, "frame", 0, 1e15)) {
    frame = studio.live.recent(static_cast<std::int64_t>(*number));
    if (!frame) throw not_found("this frame is not kept any more");
  } else {
    frame = newest_frame(studio);
  }
  Response response = bytes_response("image/jpeg", encode_jpeg(frame->image(), 92));
  response.headers.emplace("X-Frame", std::to_string(frame->number()));
  response.headers.emplace("Cache-Control", "no-store");
  return response;
}

Response post_frame(const Request& request, Studio& studio) {
  if (studio.camera.status().source != "client")
    throw conflict("frames are taken from clients only while the source is 'client'");
  Body body = request.read_body(most_bytes(studio.limits.body_mb));
  const JobSlots::Slot slot(studio.jobs);
  const SentPicture picture = decode_sent(take_picture(body), studio.limits);
  return json_response({{"frame", studio.camera.post(to_bgr8(picture.image))}});
}

}  // namespace

std::size_t most_bytes(double megabytes) {
  return static_cast<std::size_t>(megabytes * 1e6);
}

std::shared_ptr<const LiveFrame> newest_frame(const Studio& studio) {
  auto frame = studio.camera.newest();
  if (!frame) {
    const CameraStatus status = studio.camera.status();
    throw Problem(503, "no_frame",
                  "there is no picture of '" + status.source + "'" +
                      (status.message.empty() ? "" : ": " + status.message));
  }
  return frame;
}

Json live_json(const Studio& studio) {
  const CameraStatus status = studio.camera.status();
  const auto frame = studio.camera.newest();
  const auto rounded = [](double value) { return std::round(value * 100) / 100; };
  return {{"source", status.source},
          {"state", name_of(status.state)},
          {"message", status.message},
          {"since_s", rounded(status.since_s)},
          {"frame", frame ? frame->number() : -1},
          {"width", frame ? frame->image().cols : 0},
          {"height", frame ? frame->image().rows : 0},
          {"source_fps", rounded(status.fps)},
          {"recognizing", studio.settings.options().live.recognize},
          {"recognized_fps", rounded(studio.live.fps())},
          {"dropped_frames", status.dropped + studio.metrics.skipped()},
          {"streams", studio.streams.load()},
          {"objects", studio.catalogue.recognizer()->models()->objects().size()},
          {"version", studio.catalogue.version()}};
}

void add_live_routes(Router& router, Studio& studio) {
  const auto add = [&](const char* method, const char* path, auto handler) {
    router.add({method, path, Entry::protected_,
                [&studio, handler](Request& request) { return handler(request, studio); }});
  };
  add("GET", "/api/live", [](Request&, Studio& s) {
    Json json = live_json(s);
    if (const auto result = s.live.newest()) json["result"] = result->json();
    return json_response(json);
  });
  add("GET", "/api/frame.jpg", [](Request& request, Studio& s) { return get_frame(request, s); });
  add("POST", "/api/live/frame",
      [](Request& request, Studio& s) { return post_frame(request, s); });
  add("GET", "/api/source", [](Request&, Studio& s) { return json_response(source_json(s)); });
  add("PUT", "/api/source", [](Request& request, Studio& s) {
    s.camera.select(text_of(read_json(request), "source"));
    return json_response(source_json(s));
  });
}

}  // namespace posevote::server
