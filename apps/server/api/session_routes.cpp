// /api/teach-sessions: background, proposal, views, name, save.
#include <algorithm>

#include "api/routes.hpp"
#include "http/problem.hpp"
#include "json.hpp"
#include "studio/pictures.hpp"

namespace posevote::server {
namespace {

using Session = std::shared_ptr<TeachSession>;

/// The picture that was sent, or the newest frame.
SentPicture sent_or_newest(Body& body, const Studio& studio) {
  Bytes encoded = take_picture(body);
  return encoded.empty() ? from_frame(*newest_frame(studio))
                         : decode_sent(std::move(encoded), studio.limits);
}

/// What is known of the object that is to get further views; unnamed: it is a new one.
ObjectModel object_of(const Request& request, const Studio& studio) {
  const auto name = request.find("object");
  if (!name) return {};
  const auto models = studio.catalogue.recognizer()->models();
  const auto at = std::ranges::find(models->objects(), *name, &ObjectModel::name);
  if (at == models->objects().end()) throw not_found("there is no object '" + *name + "'");
  return *at;
}

Response set_background(const Request& request, const Session& session, Studio& studio) {
  Body body = request.read_body(most_bytes(studio.limits.body_mb));
  const JobSlots::Slot slot(studio.jobs);
  session->set_background(sent_or_newest(body, studio));
  return json_response(session->json());
}

Response propose(const Request& request, const Session& session, Studio& studio) {
  Wish wish;
  wish.roi = parse_rectangle(request, "roi");
  wish.whole = parse_flag(request, "whole");
  wish.yaw_deg = parse_number(request, "yaw", -360, 360).value_or(std::nan(""));
  Body body = request.read_body(most_bytes(studio.limits.body_mb));
  const JobSlots::Slot turn(session->looks());
  const JobSlots::Slot slot(studio.jobs);
  if (body.parts.contains("mask")) wish.mask = decode_within(body.parts["mask"], studio.limits);
  const Proposal proposal =
      session->propose(sent_or_newest(body, studio), wish, studio.catalogue.teach_options());
  return json_response(proposal.json());
}

Response correct(const Request& request, const Session& session, Studio& studio) {
  static_cast<void>(session->proposal());
  const Body body = request.read_body(most_bytes(studio.limits.body_mb));
  const JobSlots::Slot turn(session->looks());
  const JobSlots::Slot slot(studio.jobs);
  const cv::Mat mask = decode_within(body.raw, studio.limits);
  return json_response(session->correct(mask, studio.catalogue.teach_options()).json());
}

Response save(const Request& request, const Session& session, Studio& studio) {
  const Json json = read_json(request);
  const std::string object = text_of(json, "object");
  const auto add = json.find("add_to_existing");
  if (add != json.end() && !add->is_boolean())
    throw invalid("\"add_to_existing\" must be true or false");
  const bool add_to_existing = add != json.end() && add->get<bool>();
  int added = 0, known = 0;
  for (const AddResult& result : session->save(studio.catalogue.store(), object, add_to_existing))
    ++(result.added ? added : known);
  studio.catalogue.refresh();
  studio.metrics.count_taught(added);
  studio.sessions.discard(session->id());
  return json_response({{"object", object},
                        {"views_added", added},
                        {"views_known", known},
                        {"seconds", session->seconds()}});
}

Response mask_response(const TeachSession& session) {
  const Proposal proposal = session.proposal();
  if (proposal.mask.empty()) throw not_found("no object was found in this picture");
  return bytes_response("image/png", encode_png(proposal.mask));
}

}  // namespace

void add_session_routes(Router& router, Studio& studio) {
  router.add({"GET", "/api/teach-sessions", Entry::protected_, [&studio](Request&) {
                Json list = Json::array();
                for (const auto& session : studio.sessions.all()) list.push_back(session->json());
                return json_response({{"sessions", std::move(list)}});
              }});
  router.add({"POST", "/api/teach-sessions", Entry::protected_, [&studio](Request& request) {
                const auto session = studio.sessions.create(object_of(request, studio));
                return json_response(session->json(), 201);
              }});
  const auto add = [&](const char* method, const std::string& path, auto handler) {
    router.add({method, "/api/teach-sessions/{session}" + path, Entry::protected_,
                [&studio, handler](Request& request) {
                  return handler(request, studio.sessions.find(request["session"]), studio);
                }});
  };
  add("GET", "",
      [](Request&, const Session& session, Studio&) { return json_response(session->json()); });
  add("DELETE", "", [](Request&, const Session& session, Studio& s) {
    s.sessions.discard(session->id());
    return no_content();
  });
  add("GET", "/background", [](Request& request, const Session& session, Studio& s) {
    return picture_response(request, session->background().encoded, s.jobs, s.limits);
  });
  add("PUT", "/background", set_background);
  add("GET", "/proposal", [](Request&, const Session& session, Studio&) {
    return json_response(session->proposal().json());
  });
  add("POST", "/proposal", propose);
  add("GET", "/proposal/picture", [](Request& request, const Session& session, Studio& s) {
    return picture_response(request, session->proposal().picture.encoded, s.jobs, s.limits);
  });
  add("GET", "/proposal/mask",
      [](Request&, const Session& session, Studio&) { return mask_response(*session); });
  add("PUT", "/proposal/mask", correct);
  add("POST", "/views", [](Request& request, const Session& session, Studio& s) {
    session->accept(parse_number(request, "yaw", -360, 360), s.catalogue.features(), s.version);
    return json_response(session->json(), 201);
  });
  add("DELETE", "/views/{view}", [](Request& request, const Session& session, Studio&) {
    session->remove_view(request["view"]);
    return json_response(session->json());
  });
  add("POST", "/views/{view}/restore", [](Request& request, const Session& session, Studio&) {
    session->restore_view(request["view"]);
    return json_response(session->json());
  });
  add("GET", "/views/{view}/picture", [](Request& request, const Session& session, Studio& s) {
    return picture_response(request, session->view(request["view"]).picture, s.jobs, s.limits);
  });
  add("POST", "/save", save);
}

}  // namespace posevote::server
