// Every path, every status of openapi.yaml against the real program: what is described happens, and
// what happens is described.
#include <filesystem>
#include <set>

#include "api_description.hpp"
#include "server_process.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;

using Send = std::function<httplib::Result(httplib::Client&)>;
using Headers = httplib::Headers;

constexpr const char* kToken = "0123456789abcdef";
constexpr const char* kJson = "application/json";
constexpr const char* kJpeg = "image/jpeg";

httplib::Result send(httplib::Client& client, const std::string& method, const std::string& path,
                     const Headers& headers, const std::string& body, const std::string& type) {
  if (method == "GET") return client.Get(path, headers);
  if (method == "POST") return client.Post(path, headers, body, type);
  if (method == "PUT") return client.Put(path, headers, body, type);
  if (method == "PATCH") return client.Patch(path, headers, body, type);
  return client.Delete(path, headers, body, type);
}

std::string replace(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

class Contract : public ServerTest {
 protected:
  Contract() : api_(content(std::string(POSEVOTE_SOURCE_DIR) + "/apps/server/openapi.yaml")) {}

  const Operation& operation(const std::string& name) const {
    for (const Operation& one : api_.operations())
      if (one.name() == name) return one;
    throw std::runtime_error("openapi.yaml has no " + name);
  }

  /// Holds a response against the description; `status` must be the one asked for.
  void expect(const std::string& name, int status, const httplib::Result& result) {
    SCOPED_TRACE(name + " " + std::to_string(status));
    ASSERT_TRUE(result) << httplib::to_string(result.error());
    EXPECT_EQ(result->status, status) << result->body.substr(0, 400);
    EXPECT_EQ(api_.check(operation(name), result->status, result->get_header_value("Content-Type"),
                         result->body),
              "");
    if (result->status == status) seen_.insert(name + " " + std::to_string(status));
  }

  void expect(const std::string& name, int status, const std::string& path,
              const std::string& body = "", const std::string& type = kJpeg) {
    auto client = this->client();
    expect(name, status, send(client, name.substr(0, name.find(' ')), path, {}, body, type));
  }

  /// The path with ids of things that are there, or with `instead` for all of them.
  std::string path_of(const Operation& operation, const std::string& instead = "") const {
    std::string path = operation.path;
    for (const auto& [name, id] : ids_) {
      const std::string gap = "{" + name + "}";
      path = replace(path, gap, instead.empty() ? id : instead);
    }
    return path;
  }

  bool describes(const Operation& operation, int status) const {
    const auto statuses = operation.statuses();
    return std::ranges::find(statuses, status) != statuses.end();
  }

  void whoever_has_no_token();
  void other_sites();
  void large_bodies();
  void compressed_bodies();
  void things_that_are_not_there();
  void server_operations();
  void live_operations();
  void explain_operations();
  void object_operations();
  void teach_operations();
  void impostor_operations();
  void too_much();
  void without_a_camera();
  void pictures_of_larger_limits();
  void features_of_another_kind();

  httplib::MultipartFormDataItems with_mask(const std::string& picture, const std::string& mask) {
    return {{"picture", content(picture), "p.jpg", "image/jpeg"},
            {"mask", content(mask), "m.png", "image/png"}};
  }

  ApiDescription api_;
  std::set<std::string> seen_;
  std::map<std::string, std::string> ids_{
      {"object", "poster"}, {"view", "1"}, {"session", "x"}, {"impostor", "1"}, {"undo", "x"}};
  std::string cover_ = content(demo("train/poster/cover.jpg"));
  std::string scene_ = content(demo("train/muesli/y000.jpg"));
};

void Contract::whoever_has_no_token() {
  start({}, {{"POSEVOTE_TOKEN", kToken}});
  auto client = this->client();
  for (const Operation& one : api_.operations()) {
    const std::string method = one.method;
    if (one.open) {
      EXPECT_TRUE(one.name() == "POST /api/login" || !describes(one, 401)) << one.name();
      continue;
    }
    expect(one.name(), 401, send(client, method, path_of(one), {}, "", kJpeg));
    const auto wrong = send(client, method, path_of(one),
                            {{"Authorization", "Bearer 0123456789abcdeX"}}, "", kJpeg);
    EXPECT_EQ(wrong->status, 401) << one.name();
  }
  expect("POST /api/login", 400, "/api/login", "[]", kJson);
  expect("POST /api/login", 401, "/api/login", R"({"token": "wrong"})", kJson);
  expect("POST /api/login", 204, "/api/login", R"({"token": "0123456789abcdef"})", kJson);
  for (int i = 0; i < 9; ++i)
    expect("POST /api/login", 401, "/api/login", R"({"token": "wrong"})", kJson);
  expect("POST /api/login", 429, "/api/login", R"({"token": "0123456789abcdef"})", kJson);
}

void Contract::other_sites() {
  auto client = this->client();
  for (const Operation& one : api_.operations()) {
    if (one.method == "GET") continue;
    expect(one.name(), 403,
           send(client, one.method, path_of(one), {{"Origin", "http://evil.example"}}, "", kJpeg));
  }
}

void Contract::large_bodies() {
  const std::string large(3'200'000, 'x');
  for (const Operation& one : api_.operations()) {
    if (!describes(one, 413)) continue;
    auto client = this->client();
    expect(one.name(), 413, send(client, one.method, path_of(one), {}, large, kJpeg));
  }
}

void Contract::compressed_bodies() {
  int sent = 0;
  for (const Operation& one : api_.operations()) {
    if (!one.node["requestBody"].IsDefined()) continue;
    auto client = this->client();
    expect(one.name(), 400,
           send(client, one.method, path_of(one), {{"Content-Encoding", "gzip"}}, cover_, kJpeg));
    ++sent;
  }
  EXPECT_GT(sent, 10);
}

void Contract::things_that_are_not_there() {
  auto client = this->client();
  for (const Operation& one : api_.operations()) {
    if (!describes(one, 404) || one.path.find('{') == std::string::npos) continue;
    const bool json =
        one.path.ends_with("/merge") || one.path.ends_with("/save") || one.method == "PATCH";
    expect(one.name(), 404,
           send(client, one.method, path_of(one, "999"), {},
                json ? R"({"object": "x", "into": "poster"})" : cover_, json ? kJson : kJpeg));
  }
  expect("GET /api/frame.jpg", 404, "/api/frame.jpg?frame=999999999");
  expect("POST /api/impostors", 404, "/api/impostors?frame=999999999");
  expect("GET /api/export", 404, "/api/export?object=nobody");
}

void Contract::server_operations() {
  for (const std::string path :
       {"/api/health", "/metrics", "/api/openapi.yaml", "/api/session", "/api/settings"})
    expect("GET " + path, 200, path);
  expect("POST /api/logout", 204, "/api/logout");
  const std::string dial = "recognize.verify.false_alarms_per_1000_images";
  expect("PATCH /api/settings", 200, "/api/settings", Json{{dial, 0.5}}.dump(), kJson);
  expect("PATCH /api/settings", 200, "/api/settings", Json{{dial, nullptr}}.dump(), kJson);
  expect("PATCH /api/settings", 400, "/api/settings", Json{{dial, -1}}.dump(), kJson);
}

void Contract::live_operations() {
  ASSERT_TRUE(eventually([&] { return get("/api/live").contains("result"); }));
  expect("GET /api/live", 200, "/api/live");
  expect("GET /api/frame.jpg", 200, "/api/frame.jpg");
  expect("GET /api/frame.jpg", 400, "/api/frame.jpg?frame=x");
  expect("GET /api/stream.mjpg", 400, "/api/stream.mjpg?annotated=maybe");
  for (const std::string path : {"/api/stream.mjpg", "/api/events"}) {
    std::string type;
    int status = 0;
    EXPECT_TRUE(eventually([&] {  // the one place may still be taken by who has just left
      client().Get(
          path,
          [&](const httplib::Response& head) {
            status = head.status;
            type = head.get_header_value("Content-Type");
            return status == 200;
          },
          [](const char*, std::size_t) { return false; });
      return status == 200;
    }));
    EXPECT_EQ(api_.check(operation("GET " + path), status, type, "bytes"), "");
    if (status == 200) seen_.insert("GET " + path + " 200");
  }
  expect("GET /api/source", 200, "/api/source");
  expect("POST /api/live/frame", 409, "/api/live/frame", scene_);
  expect("PUT /api/source", 400, "/api/source", R"({"source": "/etc/passwd"})", kJson);
  const std::string camera = get("/api/source")["source"];
  expect("PUT /api/source", 200, "/api/source", R"({"source": "client"})", kJson);
  expect("POST /api/live/frame", 200, "/api/live/frame", scene_);
  expect("POST /api/live/frame", 422, "/api/live/frame", "no picture");
  expect("PUT /api/source", 200, "/api/source", Json{{"source", camera}}.dump(), kJson);
  expect("POST /api/recognize", 200, "/api/recognize", cover_);
  expect("POST /api/recognize", 200, "/api/recognize?format=jpeg", cover_);
  expect("POST /api/recognize", 400, "/api/recognize?format=gif", cover_);
  expect("POST /api/recognize", 422, "/api/recognize", "no picture");
}

void Contract::explain_operations() {
  expect("POST /api/explain", 200, "/api/explain", cover_);
  expect("POST /api/explain", 200, "/api/explain?object=poster&format=jpeg", cover_);
  expect("POST /api/explain", 400, "/api/explain?format=jpeg", cover_);
  expect("POST /api/explain", 404, "/api/explain?object=nobody", cover_);
  expect("POST /api/explain", 404, "/api/explain?object=nobody&format=jpeg", cover_);
  expect("POST /api/explain", 404, "/api/explain?frame=999999999");
  expect("POST /api/explain", 422, "/api/explain", "no picture");
  const Json found = post("/api/explain?object=poster", cover_)["explanations"][0];
  EXPECT_EQ(found["stage"], "found");
  ASSERT_TRUE(eventually([&] { return get("/api/live").contains("result"); }));
  const std::string frame = get("/api/live")["result"]["frame"].dump();
  const Json missing = post("/api/explain?frame=" + frame)["explanations"][0];
  EXPECT_EQ(missing["found"], false);
  const Json settings = get("/api/settings")["settings"];
  for (const Json& explained : {found, missing})
    EXPECT_TRUE(std::ranges::any_of(settings, [&](const Json& setting) {
      return setting["name"] == explained["option"];
    })) << explained;
}

void Contract::object_operations() {
  const std::string one = "/api/objects/poster", view = one + "/views/1";
  expect("GET /api/objects", 200, "/api/objects");
  expect("GET /api/objects/{object}", 200, one);
  expect("POST /api/objects/{object}/views", 201, "/api/objects/a%2Fb/views?roi=0,0,300,400&yaw=9",
         cover_);
  expect("POST /api/objects/{object}/views", 200, "/api/objects/a%2Fb/views?roi=0,0,300,400&yaw=9",
         cover_);
  expect("POST /api/objects/{object}/views", 400, "/api/objects/x/views?roi=1,2", cover_);
  expect("POST /api/objects/{object}/views", 422, "/api/objects/x/views", "no picture");
  const std::string views = "/api/objects/{object}/views/{view}";
  expect("GET " + views, 200, view);
  expect("GET " + views + "/picture", 200, view + "/picture");
  expect("GET " + views + "/picture", 200, view + "/picture?width=100");
  expect("GET " + views + "/picture", 400, view + "/picture?width=1");
  expect("GET " + views + "/mask", 200, view + "/mask");
  expect("GET " + views + "/quality", 200, view + "/quality");
  auto client = this->client();
  const std::string muesli = "/api/objects/muesli/views";
  const auto taught =
      client.Post(muesli, with_mask(demo("train/muesli/y000.jpg"), demo("masks/muesli/y000.png")));
  expect("POST /api/objects/{object}/views", 201, taught);
  const std::string mask = content(demo("masks/muesli/y036.png"));
  expect("PUT " + views + "/mask", 200, muesli + "/1/mask", mask, "image/png");
  expect("PUT " + views + "/mask", 400, one + "/views/1/mask", mask, "image/png");  // size
  expect("PUT " + views + "/mask", 422, one + "/views/1/mask", "no mask", "image/png");

  expect("PATCH /api/objects/{object}", 400, one, R"({"object": " x"})", kJson);
  expect("PATCH /api/objects/{object}", 409, one, R"({"object": "muesli"})", kJson);
  expect("PATCH /api/objects/{object}", 200, one, R"({"object": "poster 2"})", kJson);
  expect("PATCH /api/objects/{object}", 200, one + "%202", R"({"object": "poster"})", kJson);

  const auto undo = [&](const httplib::Result& deleted) {
    return "/api/undo/" + Json::parse(deleted->body)["undo"].get<std::string>();
  };
  const auto gone = client.Delete("/api/objects/a%2Fb");
  expect("DELETE /api/objects/{object}", 200, gone);
  expect("POST /api/undo/{undo}", 200, undo(gone));
  const auto again = client.Delete("/api/objects/a%2Fb");
  expect("GET /api/undo", 200, "/api/undo");
  expect("PATCH /api/objects/{object}", 200, "/api/objects/muesli", R"({"object": "a/b"})", kJson);
  expect("POST /api/undo/{undo}", 409, undo(again));
  expect("POST /api/objects/{object}/merge", 400, one + "/merge", R"({"into": 5})", kJson);
  expect("POST /api/objects/{object}/merge", 200, "/api/objects/a%2Fb/merge",
         R"({"into": "poster"})", kJson);
  const auto deleted = client.Delete(view);
  expect("DELETE /api/objects/{object}/views/{view}", 200, deleted);
  expect("POST /api/undo/{undo}", 200, undo(deleted));
  ids_["view"] = get(one)["views"].back()["view"];

  const auto file = client.Get("/api/export");
  expect("GET /api/export", 200, file);
  expect("POST /api/import", 409, "/api/import", file->body);
  expect("POST /api/import", 200, "/api/import?existing=merge", file->body);
  expect("POST /api/import", 400, "/api/import?existing=maybe", file->body);
  expect("POST /api/import", 422, "/api/import", "no database");
}

void Contract::teach_operations() {
  const std::string sessions = "/api/teach-sessions", of = sessions + "/{session}";
  const Json made = post(sessions);
  const std::string id = made["session"], one = sessions + "/" + id;
  ids_["session"] = id;
  expect("GET " + sessions, 200, sessions);
  expect("POST " + sessions, 404, sessions + "?object=nobody");
  expect("GET " + of, 200, one);
  expect("GET " + of + "/background", 404, one + "/background");
  expect("PUT " + of + "/background", 200, one + "/background",
         content(demo("train/muesli/background.jpg")));
  expect("PUT " + of + "/background", 200, one + "/background");  // the newest frame
  expect("PUT " + of + "/background", 422, one + "/background", "no picture");
  expect("PUT " + of + "/background", 200, one + "/background",
         content(demo("train/muesli/background.jpg")));
  expect("GET " + of + "/background", 200, one + "/background");
  expect("GET " + of + "/background", 400, one + "/background?width=x");
  expect("POST " + of + "/proposal", 400, one + "/proposal?yaw=much", scene_);
  expect("POST " + of + "/proposal", 422, one + "/proposal", "no picture");
  expect("POST " + of + "/proposal", 200, one + "/proposal",
         content(demo("train/muesli/background.jpg")));  // no object on it
  expect("GET " + of + "/proposal/mask", 404, one + "/proposal/mask");
  expect("POST " + of + "/views", 409, one + "/views");
  expect("POST " + of + "/save", 409, one + "/save", R"({"object": "cereal"})", kJson);
  expect("POST " + of + "/proposal", 200, one + "/proposal?yaw=0", scene_);
  expect("GET " + of + "/proposal", 200, one + "/proposal");
  expect("GET " + of + "/proposal/picture", 200, one + "/proposal/picture");
  expect("GET " + of + "/proposal/picture", 400, one + "/proposal/picture?width=x");
  expect("GET " + of + "/proposal/mask", 200, one + "/proposal/mask");
  const std::string mask = content(demo("masks/muesli/y000.png"));
  expect("PUT " + of + "/proposal/mask", 200, one + "/proposal/mask", mask, "image/png");
  expect("PUT " + of + "/proposal/mask", 400, one + "/proposal/mask", cover_);  // another size
  expect("PUT " + of + "/proposal/mask", 422, one + "/proposal/mask", "no mask");
  expect("POST " + of + "/views", 400, one + "/views?yaw=x");
  expect("POST " + of + "/views", 201, one + "/views");
  expect("GET " + of + "/views/{view}/picture", 200, one + "/views/1/picture");
  expect("GET " + of + "/views/{view}/picture", 400, one + "/views/1/picture?width=x");
  expect("POST " + of + "/save", 400, one + "/save", R"({"object": ""})", kJson);
  expect("POST " + of + "/save", 409, one + "/save", R"({"object": "poster"})", kJson);
  expect("POST " + of + "/proposal", 200, one + "/proposal", scene_);
  expect("POST " + of + "/views", 201, one + "/views");
  expect("DELETE " + of + "/views/{view}", 200, one + "/views/2");
  expect("POST " + of + "/views/{view}/restore", 200, one + "/views/2/restore");
  expect("POST " + of + "/proposal", 200, one + "/proposal", scene_);
}

void Contract::impostor_operations() {
  expect("POST /api/impostors", 201, "/api/impostors?box=10,10,200,200", scene_);
  expect("POST /api/impostors", 400, "/api/impostors?box=5000,5000,9,9", scene_);
  expect("POST /api/impostors", 422, "/api/impostors", "no picture");
  expect("GET /api/impostors", 200, "/api/impostors");
  const std::string one = "/api/impostors/{impostor}", first = "/api/impostors/1";
  expect("GET " + one + "/picture", 200, first + "/picture");
  expect("GET " + one + "/picture", 400, first + "/picture?width=1e9");
}

/// Sends while the only place among the jobs is taken, until that is said.
void Contract::too_much() {
  const std::string one = "/api/teach-sessions/" + ids_["session"];
  post(one + "/proposal", scene_);  // the one in hand went with the server before
  client().Put(one + "/background", scene_, kJpeg);
  const std::string file = client().Get("/api/export")->body;
  std::atomic<bool> stop = false;
  std::vector<std::thread> others;
  others.reserve(3);
  for (int i = 0; i < 3; ++i)
    others.emplace_back([&] {
      auto client = this->client();
      while (!stop) client.Post("/api/recognize", content(demo("test/kitchen.jpg")), kJpeg);
    });
  const std::string views = "/api/objects/{object}/views/{view}";
  struct Asked {
    std::string name, path, body;
  };
  const std::vector<Asked> requests{
      {"POST /api/recognize", "/api/recognize", cover_},
      {"POST /api/explain", "/api/explain", cover_},
      {"POST /api/impostors", "/api/impostors", cover_},
      {"POST /api/objects/{object}/views", "/api/objects/poster/views", cover_},
      {"PUT " + views + "/mask", "/api/objects/poster/views/" + ids_["view"] + "/mask",
       "a good mask would make another view"},
      {"GET " + views + "/quality", "/api/objects/poster/views/" + ids_["view"] + "/quality", ""},
      {"PUT /api/teach-sessions/{session}/proposal/mask", one + "/proposal/mask", cover_},
      {"POST /api/live/frame", "/api/live/frame", cover_},
      {"GET /api/export", "/api/export", ""},
      {"POST /api/import", "/api/import?existing=merge", file},
      {"GET /api/impostors/{impostor}/picture", "/api/impostors/1/picture?width=99", ""},
      {"GET " + views + "/picture",
       "/api/objects/poster/views/" + ids_["view"] + "/picture?width=99", ""},
      {"GET /api/teach-sessions/{session}/background", one + "/background?width=99", ""},
      {"GET /api/teach-sessions/{session}/proposal/picture", one + "/proposal/picture?width=99",
       ""},
      {"GET /api/teach-sessions/{session}/views/{view}/picture", one + "/views/1/picture?width=99",
       ""}};
  for (const Asked& asked : requests) {
    auto client = this->client();
    httplib::Result result(nullptr, httplib::Error::Unknown);
    EXPECT_TRUE(eventually([&] {
      result = send(client, asked.name.substr(0, asked.name.find(' ')), asked.path, {}, asked.body,
                    kJpeg);
      return result && result->status == 503;
    })) << asked.name;
    expect(asked.name, 503, result);
  }
  stop = true;
  for (std::thread& other : others) other.join();
}

void Contract::without_a_camera() {
  for (const auto& path : {"/background", "/proposal"}) {
    const std::string method = path == std::string("/background") ? "PUT" : "POST";
    expect(method + " /api/teach-sessions/{session}" + path, 503,
           "/api/teach-sessions/" + ids_["session"] + path);
  }
  expect("GET /api/frame.jpg", 503, "/api/frame.jpg");
}

/// Meanwhile views with other features have come into the empty database.
void Contract::features_of_another_kind() {
  const auto forget_all = [&] {
    server_.reset();
    for (const char* suffix : {"", "-wal", "-shm"}) fs::remove(folder_ + "/objects.db" + suffix);
  };
  forget_all();
  start({"--set", "recognize.feature.kind=sift"});
  teach_poster();
  const std::string other = client().Get("/api/export")->body;
  forget_all();
  start();
  const std::string name = "POST /api/objects/{object}/views",
                    scene = content(demo("test/kitchen.jpg"));
  httplib::Result taught(nullptr, httplib::Error::Unknown);
  int delay_ms = 0;
  EXPECT_TRUE(eventually([&] {  // the import must come while the picture is looked at
    std::jthread teacher([&] { taught = client().Post("/api/objects/x/views", scene, kJpeg); });
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms += 20));
    client().Post("/api/import", other, "application/octet-stream");
    teacher.join();
    for (const char* object : {"x", "poster"})
      client().Delete(std::string("/api/objects/") + object);
    return taught && taught->status == 409;
  }));
  expect(name, 409, taught);
  EXPECT_EQ(Json::parse(taught->body)["error"]["code"], "feature_mismatch");
}

/// They are there, but are not made smaller.
void Contract::pictures_of_larger_limits() {
  start({"--set", "limits.megapixels=0.01"});
  const std::string of = "/api/teach-sessions/";
  expect("GET /api/impostors/{impostor}/picture", 422, "/api/impostors/1/picture?width=99");
  expect("GET /api/objects/{object}/views/{view}/picture", 422,
         "/api/objects/poster/views/" + ids_["view"] + "/picture?width=99");
  expect("GET " + of + "{session}/views/{view}/picture", 422,
         of + ids_["session"] + "/views/1/picture?width=99");
}

TEST_F(Contract, EveryPathAndEveryStatus) {
  whoever_has_no_token();
  const std::string camera = make_camera("camera", {demo("train/muesli/y000.jpg")});
  start({"--camera", camera, "--set", "limits.body_mb=1", "--set", "limits.import_mb=3", "--set",
         "limits.sessions=2", "--set", "limits.streams=1", "--set", "limits.jobs=1", "--set",
         "limits.wait_s=30"});
  teach_poster();
  other_sites();
  server_operations();
  live_operations();
  explain_operations();
  object_operations();
  teach_operations();
  impostor_operations();
  expect("PUT /api/source", 200, "/api/source", R"({"source": "client"})", kJson);
  large_bodies();
  compressed_bodies();
  things_that_are_not_there();

  const std::string sessions = "/api/teach-sessions";
  expect("POST " + sessions, 201, sessions);
  expect("POST " + sessions, 429, sessions);
  auto watcher = client();
  watcher.Get("/api/events", [&](const char*, std::size_t) {
    expect("GET /api/stream.mjpg", 429, "/api/stream.mjpg");
    expect("GET /api/events", 429, "/api/events");
    return false;
  });

  start({"--set", "limits.jobs=1", "--set", "limits.wait_s=0.1"});  // "client", which sends nothing
  without_a_camera();
  too_much();
  pictures_of_larger_limits();
  expect("DELETE /api/impostors/{impostor}", 204, "/api/impostors/1");
  const std::string one = sessions + "/" + ids_["session"];
  expect("POST " + sessions + "/{session}/save", 200, one + "/save", R"({"object": "cereal"})",
         kJson);
  const std::string last = post(sessions)["session"];
  expect("DELETE " + sessions + "/{session}", 204, sessions + "/" + last);

  features_of_another_kind();

  for (const Operation& one_of : api_.operations())
    for (const int status : one_of.statuses())
      EXPECT_TRUE(seen_.contains(one_of.name() + " " + std::to_string(status)))
          << one_of.name() << " " << status << " is described, but no test has seen it";
}

TEST_F(Contract, TroubleOfTheServersOwn) {
  start();
  teach_poster();
  fs::remove_all(folder_ + "/objects.db.studio/undo");
  expect("GET /api/export", 500, "/api/export");
  expect("DELETE /api/objects/{object}", 500, "/api/objects/poster");
}

TEST_F(Contract, TheProgramServesThisVeryDescription) {
  start();
  EXPECT_EQ(client().Get("/api/openapi.yaml")->body,
            content(std::string(POSEVOTE_SOURCE_DIR) + "/apps/server/openapi.yaml"));
}

TEST_F(Contract, UnknownPathsAndMethods) {
  start();
  const auto status = [&](const httplib::Result& result) { return result ? result->status : 0; };
  EXPECT_EQ(status(client().Get("/api/nothing")), 404);
  EXPECT_EQ(status(client().Get("/nothing.html")), 404);
  EXPECT_EQ(status(client().Delete("/api/objects")), 405);
  EXPECT_EQ(status(client().Options("/api/objects")), 405);
  EXPECT_EQ(status(client().Head("/api/objects")), 200);
}

}  // namespace
}  // namespace posevote
