// The HTTP interface of openapi.yaml, one file for each group of paths.
#pragma once

#include "http/router.hpp"
#include "studio/studio.hpp"

namespace posevote::server {

void add_live_routes(Router& router, Studio& studio);
void add_stream_routes(Router& router, Studio& studio);
void add_recognize_routes(Router& router, Studio& studio);
void add_object_routes(Router& router, Studio& studio);
void add_view_routes(Router& router, Studio& studio);
void add_transfer_routes(Router& router, Studio& studio);
void add_session_routes(Router& router, Studio& studio);
void add_server_routes(Router& router, Studio& studio);

/// The newest frame; throws Problem 503 "no_frame" with the reason.
[[nodiscard]] std::shared_ptr<const LiveFrame> newest_frame(const Studio& studio);

/// Live of openapi.yaml.
[[nodiscard]] Json live_json(const Studio& studio);

/// Bytes that a request body may have.
[[nodiscard]] std::size_t most_bytes(double megabytes);

/// A view of an object, as View of openapi.yaml.
[[nodiscard]] Json full_view_json(const ObjectStore& store, const std::string& object,
                                  const std::string& view);

}  // namespace posevote::server
