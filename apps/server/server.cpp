#include "server.hpp"

#include "api/routes.hpp"
#include "http/problem.hpp"
#include "static_page.hpp"

namespace posevote::server {
namespace {

void add_security_headers(Response& response) {
  auto& headers = response.headers;
  headers.emplace("Content-Security-Policy",
                  "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: "
                  "data:; connect-src 'self'; media-src 'self' blob:; font-src 'self'; "
                  "manifest-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'self'; "
                  "frame-ancestors 'none'");
  headers.emplace("X-Content-Type-Options", "nosniff");
  headers.emplace("X-Frame-Options", "DENY");
  headers.emplace("Referrer-Policy", "no-referrer");
  headers.emplace("Cross-Origin-Resource-Policy", "same-origin");
  headers.emplace("Cross-Origin-Opener-Policy", "same-origin");
  headers.emplace("Permissions-Policy", "camera=(self), microphone=(), geolocation=()");
  if (!headers.contains("Cache-Control")) headers.emplace("Cache-Control", "no-store");
}

bool is_interface(const std::string& path) {
  return path.starts_with("/api/") || path == "/metrics";
}

Response to_response(const Problem& problem) {
  Response response;
  response.status = problem.status();
  response.type = "application/json";
  response.body = problem_json(problem);
  if (problem.status() == 401) response.headers.emplace("WWW-Authenticate", "Bearer");
  if (problem.status() == 503) response.headers.emplace("Retry-After", "2");
  return response;
}

}  // namespace

Server::Server(StudioConfig config)
    : studio_(std::move(config)), http_(studio_.limits, [this](Request& request) {
        Response response;
        try {
          response = answer(request);
        } catch (...) {
          response = to_response(to_problem(std::current_exception()));
        }
        studio_.metrics.count_request(response.status);
        add_security_headers(response);
        return response;
      }) {
  for (const auto add :
       {add_live_routes, add_stream_routes, add_recognize_routes, add_object_routes,
        add_view_routes, add_transfer_routes, add_session_routes, add_server_routes})
    add(router_, studio_);
}

Server::~Server() {
  stop();
}

Response Server::answer(Request& request) {
  studio_.access.check_origin(request);
  if (request.method == "GET" && !is_interface(request.path))
    return page_response(request, embedded_page());
  const Route& route = router_.find(request);
  if (route.entry == Entry::protected_) studio_.access.check_token(request);
  return route.handler(request);
}

int Server::start(const std::string& host, int port,
                  std::unique_ptr<const Certificate> certificate) {
  return http_.start(host, port, std::move(certificate));
}

void Server::stop() {
  http_.stop();
  studio_.stop();
}

}  // namespace posevote::server
