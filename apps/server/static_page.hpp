// The page's files.
#pragma once

#include <vector>

#include "embedded.hpp"
#include "http/message.hpp"

namespace posevote::server {

/// The file at `request.path` ("/": index.html), or 304 when the client has it. Throws Problem 404.
/// Without any files, "/" says so in one sentence.
[[nodiscard]] Response page_response(const Request& request,
                                     const std::vector<EmbeddedFile>& files);

}  // namespace posevote::server
