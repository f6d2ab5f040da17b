#include "http/limits.hpp"

namespace posevote::server {

void Limits::describe(OptionList& list) {
  list.add("connections", connections, {2, 900}, "", "Connections at once; more are turned away.");
  list.add("streams", streams, {1, 500}, "", "Clients that watch frames or events at once.");
  list.add("sessions", sessions, {1, 1000}, "", "Teach sessions at once.");
  list.add("jobs", jobs, {1, 64}, "", "Requests that are computed at once.");
  list.add("body_mb", body_mb, {0.001, 1000}, "MB", "Largest request body.");
  list.add("import_mb", import_mb, {0.001, 100000}, "MB", "Largest imported file.");
  list.add("bodies_mb", bodies_mb, {1, 100000}, "MB", "All request bodies in memory together.");
  list.add("megapixels", megapixels, {0.01, 1000}, "MP", "Largest picture.");
  list.add("request_s", request_s, {0.1, 3600}, "s",
           "Time for a request to arrive, and a second more for every 256 KB.");
  list.add("wait_s", wait_s, {0.1, 600}, "s",
           "Time that requests wait for others, or for clients.");
  list.add("idle_s", idle_s, {0.1, 3600}, "s", "Silence after which a connection is closed.");
  list.add("session_idle_s", session_idle_s, {1, 1e7}, "s",
           "Silence after which a teach session is discarded.");
  list.add("undo_s", undo_s, {1, 1e7}, "s", "Time during which a deletion can be undone.");
}

}  // namespace posevote::server
