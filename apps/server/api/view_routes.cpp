// /api/objects/{object}/views: teach from pictures that are sent, look at views, correct masks.
#include <algorithm>

#include "api/routes.hpp"
#include "http/problem.hpp"
#include "json.hpp"
#include "posevote/store/object_name.hpp"
#include "studio/pictures.hpp"

namespace posevote::server {
namespace {

const char* method_of(const ViewSource& source) {
  if (!source.mask.empty()) return "mask";
  if (!source.background.empty()) return "background";
  return source.roi ? "roi" : "whole";
}

Response teach(const Request& request, Studio& studio) {
  const std::string& name = request["object"];
  check_object_name(name);
  ViewSource source;
  source.roi = parse_rectangle(request, "roi");
  source.yaw_deg = parse_number(request, "yaw", -360, 360).value_or(std::nan(""));
  const std::string from = request.find("source").value_or("upload").substr(0, 200);
  Body body = request.read_body(most_bytes(studio.limits.body_mb));

  const JobSlots::Slot slot(studio.jobs);
  SentPicture picture = decode_sent(take_picture(body), studio.limits);
  source.picture = picture.image;
  if (body.parts.contains("mask")) source.mask = decode_within(body.parts["mask"], studio.limits);
  if (body.parts.contains("background"))
    source.background = decode_within(body.parts["background"], studio.limits);
  const TeachOptions options = studio.catalogue.teach_options();
  TaughtView taught;
  taught.view = teach_view(source, options);
  taught.picture = std::move(picture.encoded);
  taught.method = method_of(source);
  taught.provenance = {from, "", studio.version};
  ObjectStore& store = studio.catalogue.store();
  const AddResult result = store.add_view(name, taught, record_features(options.feature));
  studio.catalogue.refresh();
  if (result.added) studio.metrics.count_taught(1);
  return json_response(full_view_json(store, name, result.id), result.added ? 201 : 200);
}

/// The same picture with another mask, in place of the old view.
Response replace_mask(const Request& request, Studio& studio) {
  const std::string &object = request["object"], &id = request["view"];
  ObjectStore& store = studio.catalogue.store();
  TaughtView taught = store.view(object, id);
  const Body body = request.read_body(most_bytes(studio.limits.body_mb));

  const JobSlots::Slot slot(studio.jobs);
  const TeachOptions options = studio.catalogue.teach_options();
  ViewSource source;
  source.picture = decode_within(taught.picture, studio.limits);
  source.mask = decode_within(body.raw, studio.limits);
  source.yaw_deg = taught.view.yaw_deg;
  taught.view = teach_view(source, options);
  taught.mask.clear();
  taught.method = "mask";
  taught.provenance.taught_at.clear();
  taught.provenance.version = studio.version;
  AddResult result;
  store.transact([&] {
    static_cast<void>(store.view(object, id));  // still there?
    result = store.add_view(object, taught, record_features(options.feature));
    if (result.id != id) store.remove_view(object, id);
  });
  studio.catalogue.refresh();
  return json_response(full_view_json(store, object, result.id));
}

Response quality(const Request& request, Studio& studio) {
  const JobSlots::Slot slot(studio.jobs);
  LoadOptions load;
  load.pictures = true;
  const ObjectModel object = studio.catalogue.store().load_object(request["object"], load);
  const auto at =
      std::ranges::find(object.views, request["view"], [](const auto& v) { return v->id; });
  if (at == object.views.end()) throw not_found("there is no view '" + request["view"] + "'");
  QualityOptions options;
  options.feature = studio.catalogue.features();
  return json_response(quality_json(assess_view(**at, object.views, options)));
}

}  // namespace

Json full_view_json(const ObjectStore& store, const std::string& object, const std::string& view) {
  const auto views = store.views(object);
  const auto summary = std::ranges::find(views, view, &ViewSummary::id);
  if (summary == views.end())
    throw not_found("there is no view '" + view + "' of object '" + object + "'");
  Json json{{"object", object}};
  json.update(view_json(*summary));
  json["outline"] = points_json(store.view(object, view).view.outline);
  return json;
}

void add_view_routes(Router& router, Studio& studio) {
  const auto add = [&](const char* method, const std::string& path, auto handler) {
    router.add({method, "/api/objects/{object}/views" + path, Entry::protected_,
                [&studio, handler](Request& request) { return handler(request, studio); }});
  };
  add("POST", "", [](Request& request, Studio& s) { return teach(request, s); });
  add("GET", "/{view}", [](Request& request, Studio& s) {
    return json_response(full_view_json(s.catalogue.store(), request["object"], request["view"]));
  });
  add("GET", "/{view}/picture", [](Request& request, Studio& s) {
    return picture_response(request,
                            s.catalogue.store().view(request["object"], request["view"]).picture,
                            s.jobs, s.limits);
  });
  add("GET", "/{view}/mask", [](Request& request, Studio& s) {
    return bytes_response("image/png",
                          s.catalogue.store().view(request["object"], request["view"]).mask);
  });
  add("PUT", "/{view}/mask", [](Request& request, Studio& s) { return replace_mask(request, s); });
  add("GET", "/{view}/quality", [](Request& request, Studio& s) { return quality(request, s); });
}

}  // namespace posevote::server
