// /api/stream.mjpg and /api/events: what happens, as long as the client looks.
#include "api/routes.hpp"
#include "http/problem.hpp"
#include "json.hpp"
#include "studio/pictures.hpp"

namespace posevote::server {
namespace {

using std::chrono::milliseconds;

/// A place among those who watch.
class StreamPlace {
 public:
  explicit StreamPlace(Studio& studio) : studio_(studio) {
    if (++studio_.streams > studio_.limits.streams) {
      --studio_.streams;
      throw too_many("too many clients are watching; close another page");
    }
  }
  ~StreamPlace() { --studio_.streams; }
  StreamPlace(const StreamPlace&) = delete;
  StreamPlace& operator=(const StreamPlace&) = delete;

 private:
  Studio& studio_;
};

std::string part_of(const LiveFrame& frame, const Bytes& jpeg) {
  std::string part =
      "--frame\r\nContent-Type: image/jpeg\r\nX-Frame: " + std::to_string(frame.number()) +
      "\r\nX-Width: " + std::to_string(frame.image().cols) +
      "\r\nX-Height: " + std::to_string(frame.image().rows) +
      "\r\nContent-Length: " + std::to_string(jpeg.size()) + "\r\n\r\n";
  part.append(jpeg.begin(), jpeg.end());
  return part + "\r\n";
}

/// Sends the newest frame whenever the client has taken the one before.
void send_frames(Studio& studio, Sink& sink) {
  std::int64_t last = -1;
  std::uint64_t seen = 0;
  while (!sink.closed()) {
    const auto frame = studio.camera.newest();
    if (!frame || frame->number() == last) {
      seen = studio.bell.wait(seen, milliseconds(250));
      continue;
    }
    if (last >= 0)
      studio.metrics.count_missed(std::max<std::int64_t>(0, frame->number() - last - 1));
    last = frame->number();
    if (!sink.write(part_of(*frame, frame->stream_jpeg()))) return;
  }
}

void send_annotated(Studio& studio, Sink& sink) {
  std::shared_ptr<const LiveResult> last;
  std::uint64_t seen = 0;
  while (!sink.closed()) {
    const auto result = studio.live.newest();
    if (!result || result == last) {
      seen = studio.bell.wait(seen, milliseconds(250));
      continue;
    }
    last = result;
    const Bytes& jpeg = result->annotated_jpeg(studio.settings.options().live);
    if (!sink.write(part_of(result->frame(), jpeg))) return;
  }
}

std::string event(const char* name, const std::string& data) {
  return std::string("event: ") + name + "\ndata: " + data + "\n\n";
}

/// Says what has changed since it was last called.
class Changes {
 public:
  std::string next(const Studio& studio) {
    std::string text;
    const CameraStatus status = studio.camera.status();
    const double now_s = studio.camera.now_s();
    const std::string state = status.source + '\n' + status.message;
    if (state != state_ || now_s >= due_s_) {
      text += event("live", to_line(live_json(studio)));
      state_ = state;
      due_s_ = now_s + 1;
    }
    if (const std::int64_t version = studio.catalogue.version(); version != version_) {
      text += event("objects", to_line({{"version", version}}));
      version_ = version;
    }
    if (const auto result = studio.live.newest(); result && result != result_) {
      text += event("result", result->text());
      result_ = result;
    }
    return text;
  }

 private:
  std::string state_ = "?";
  double due_s_ = 0;
  std::int64_t version_ = -1;
  std::shared_ptr<const LiveResult> result_;
};

void send_events(Studio& studio, Sink& sink) {
  Changes changes;
  std::uint64_t seen = 0;
  while (!sink.closed()) {
    const std::string text = changes.next(studio);
    if (!text.empty() && !sink.write(text)) return;
    if (text.empty()) seen = studio.bell.wait(seen, milliseconds(250));
  }
}

Response stream(Studio& studio, const std::string& type, void (*send)(Studio&, Sink&)) {
  const auto place = std::make_shared<StreamPlace>(studio);
  Response response;
  response.type = type;
  response.headers.emplace("Cache-Control", "no-store");
  response.headers.emplace("X-Accel-Buffering", "no");
  response.stream = [&studio, send, place](Sink& sink) { send(studio, sink); };
  return response;
}

}  // namespace

void add_stream_routes(Router& router, Studio& studio) {
  router.add({"GET", "/api/stream.mjpg", Entry::protected_, [&studio](Request& request) {
                return stream(studio, "multipart/x-mixed-replace; boundary=frame",
                              parse_flag(request, "annotated") ? send_annotated : send_frames);
              }});
  router.add({"GET", "/api/events", Entry::protected_,
              [&studio](Request&) { return stream(studio, "text/event-stream", send_events); }});
}

}  // namespace posevote::server
