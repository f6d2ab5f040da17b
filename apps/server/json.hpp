// The server's own JSON: quality cards, impostors. Objects and views are common/store_json's,
// recognition results posevote/json's.
#pragma once

#include "http/message.hpp"
#include "posevote/json/recognition_json.hpp"
#include "posevote/store/object_store.hpp"
#include "posevote/teach/quality.hpp"
#include "store_json.hpp"

namespace posevote::server {

[[nodiscard]] Response json_response(const Json& json, int status = 200);

/// The request's body as a JSON object. Throws Problem 400, 413.
[[nodiscard]] Json read_json(const Request& request);

/// `json[name]` as text; throws Problem 400 when it is not there or no text.
[[nodiscard]] std::string text_of(const Json& json, const char* name);

[[nodiscard]] Json points_json(const std::vector<cv::Point2f>& points);
[[nodiscard]] Json quality_json(const ViewQuality& quality);
[[nodiscard]] Json impostor_json(const ImpostorSummary& impostor);

/// Where the next picture of these views helps most; null: no gap, or no yaw is known.
[[nodiscard]] Json next_yaw_json(const std::vector<double>& yaws_deg);

/// The yaws of those views of which they are known.
[[nodiscard]] std::vector<double> yaws_of(const std::vector<ViewSummary>& views);

}  // namespace posevote::server
