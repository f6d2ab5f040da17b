// Access, settings, health and metrics.
#include <cmath>
#include <fstream>
#include <sstream>

#include <unistd.h>

#include "api/routes.hpp"
#include "embedded.hpp"
#include "http/problem.hpp"
#include "json.hpp"

namespace posevote::server {
namespace {

double resident_bytes() {
  std::ifstream file("/proc/self/statm");
  double total = 0, resident = 0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// NaN: its server does not answer.
double database_bytes(const ObjectStore& store) {
  try {
    return static_cast<double>(store.size_bytes());
  } catch (const Error&) {
    return std::nan("");
  }
}

Response metrics(const Studio& studio) {
  std::ostringstream out;
  studio.metrics.write(out);
  const CameraStatus camera = studio.camera.status();
  const auto models = studio.catalogue.recognizer()->models();
  const auto gauge = [&](const char* name, const char* help, double value) {
    write_metric(out, name, "gauge", help, value);
  };
  write_metric(out, "posevote_frames_total", "counter", "Frames that the source gave.",
               static_cast<double>(camera.frames));
  write_metric(out, "posevote_frames_dropped_total", "counter",
               "Frames that came too fast to be taken.", static_cast<double>(camera.dropped));
  gauge("posevote_source_up", "1: frames come.", camera.state == CameraState::running ? 1 : 0);
  gauge("posevote_source_fps", "Frames a second.", camera.fps);
  gauge("posevote_recognized_fps", "Results a second.", studio.live.fps());
  gauge("posevote_streams", "Clients that watch.", studio.streams);
  gauge("posevote_teach_sessions", "Teach sessions in hand.",
        static_cast<double>(studio.sessions.all().size()));
  gauge("posevote_objects", "Taught objects.", static_cast<double>(models->objects().size()));
  gauge("posevote_views", "Taught views.", static_cast<double>(models->views().size()));
  gauge("posevote_taught_features", "Features of all views.",
        static_cast<double>(models->feature_count()));
  gauge("posevote_database_bytes", "Size of the database.",
        database_bytes(studio.catalogue.store()));
  gauge("process_resident_memory_bytes", "Memory in use.", resident_bytes());
  Response response;
  response.type = "text/plain; version=0.0.4; charset=utf-8";
  response.body = out.str();
  return response;
}

Response login(const Request& request, Studio& studio) {
  Response response = no_content();
  response.headers.emplace("Set-Cookie", studio.access.login(text_of(read_json(request), "token")));
  return response;
}

Response change_settings(const Request& request, Studio& studio) {
  studio.settings.change(read_json(request));
  studio.camera.set_options(studio.settings.options().live);
  studio.catalogue.refresh();
  return json_response(studio.settings.json());
}

}  // namespace

void add_server_routes(Router& router, Studio& studio) {
  const auto add = [&](const char* method, const char* path, Entry entry, auto handler) {
    router.add({method, path, entry,
                [&studio, handler](Request& request) { return handler(request, studio); }});
  };
  add("GET", "/api/health", Entry::open, [](Request&, Studio& s) {
    return json_response({{"status", "ok"}, {"version", s.version}});
  });
  add("GET", "/metrics", Entry::protected_, [](Request&, Studio& s) { return metrics(s); });
  add("GET", "/api/openapi.yaml", Entry::open, [](Request&, Studio&) {
    Response response;
    response.type = "application/yaml";
    response.body = *find_embedded(embedded_api(), "openapi.yaml");
    return response;
  });
  add("GET", "/api/session", Entry::open, [](Request& request, Studio& s) {
    return json_response({{"token_needed", s.access.token_needed()},
                          {"authenticated", s.access.authenticated(request)},
                          {"version", s.version}});
  });
  add("POST", "/api/login", Entry::open,
      [](Request& request, Studio& s) { return login(request, s); });
  add("POST", "/api/logout", Entry::open, [](Request&, Studio& s) {
    Response response = no_content();
    response.headers.emplace("Set-Cookie", s.access.logout());
    return response;
  });
  add("GET", "/api/settings", Entry::protected_,
      [](Request&, Studio& s) { return json_response(s.settings.json()); });
  add("PATCH", "/api/settings", Entry::protected_,
      [](Request& request, Studio& s) { return change_settings(request, s); });
}

}  // namespace posevote::server
