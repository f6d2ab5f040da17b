// /api/objects and /api/undo: look at objects, rename, merge, delete and undo.
#include <algorithm>

#include "api/routes.hpp"
#include "http/problem.hpp"
#include "json.hpp"

namespace posevote::server {
namespace {

Response list(const Studio& studio) {
  const ObjectStore& store = studio.catalogue.store();
  Json objects = Json::array();
  for (const ObjectSummary& object : store.list()) {
    Json json = object_json(object);
    try {
      json["cover"] = store.views(object.name).front().id;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::not_found) throw;
      continue;  // deleted in between
    }
    objects.push_back(std::move(json));
  }
  return json_response({{"objects", std::move(objects)},
                        {"version", store.version()},
                        {"features", studio.catalogue.features().signature()}});
}

Json full_object_json(const ObjectStore& store, const std::string& name) {
  const auto views = store.views(name);
  Json list = Json::array();
  for (const ViewSummary& view : views) list.push_back(view_json(view));
  return {
      {"object", name}, {"views", std::move(list)}, {"next_yaw", next_yaw_json(yaws_of(views))}};
}

Response undo_response(Studio& studio, const std::string& id) {
  studio.catalogue.refresh();
  return json_response({{"undo", id}, {"expires_s", studio.limits.undo_s}});
}

Json deletions_json(const Studio& studio) {
  const auto text_or_null = [](const std::string& text) {
    return text.empty() ? Json() : Json(text);
  };
  Json list = Json::array();
  for (const Deletion& one : studio.trash.list())
    list.push_back({{"undo", one.id},
                    {"expires_s", std::max(0.0, studio.limits.undo_s - one.age_s)},
                    {"age_s", one.age_s},
                    {"object", one.object},
                    {"view", text_or_null(one.view)},
                    {"into", text_or_null(one.into)}});
  return {{"deletions", std::move(list)}};
}

}  // namespace

void add_object_routes(Router& router, Studio& studio) {
  const auto add = [&](const char* method, const char* path, auto handler) {
    router.add({method, path, Entry::protected_,
                [&studio, handler](Request& request) { return handler(request, studio); }});
  };
  add("GET", "/api/objects", [](Request&, Studio& s) { return list(s); });
  add("GET", "/api/objects/{object}", [](Request& request, Studio& s) {
    return json_response(full_object_json(s.catalogue.store(), request["object"]));
  });
  add("PATCH", "/api/objects/{object}", [](Request& request, Studio& s) {
    const std::string name = text_of(read_json(request), "object");
    s.catalogue.store().rename_object(request["object"], name);
    s.catalogue.refresh();
    return json_response(full_object_json(s.catalogue.store(), name));
  });
  add("DELETE", "/api/objects/{object}", [](Request& request, Studio& s) {
    return undo_response(s, s.trash.delete_object(s.catalogue.store(), request["object"]));
  });
  add("POST", "/api/objects/{object}/merge", [](Request& request, Studio& s) {
    const std::string into = text_of(read_json(request), "into");
    return undo_response(s, s.trash.merge(s.catalogue.store(), request["object"], into));
  });
  add("DELETE", "/api/objects/{object}/views/{view}", [](Request& request, Studio& s) {
    return undo_response(
        s, s.trash.delete_view(s.catalogue.store(), request["object"], request["view"]));
  });
  add("GET", "/api/undo", [](Request&, Studio& s) { return json_response(deletions_json(s)); });
  add("POST", "/api/undo/{undo}", [](Request& request, Studio& s) {
    const std::string name = s.trash.undo(s.catalogue.store(), request["undo"]);
    s.catalogue.refresh();
    return json_response(full_object_json(s.catalogue.store(), name));
  });
}

}  // namespace posevote::server
