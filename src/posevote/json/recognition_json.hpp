// Recognition results as JSON: the one place that knows the names of the fields.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posevote/recognize/explain.hpp"
#include "posevote/recognize/recognizer.hpp"

namespace posevote {

using Json = nlohmann::ordered_json;

/// {"image", "width", "height", "time_ms": {...}, "counts": {...}, "detections": [...], and, when
/// there are any, "unknown": [{"box", "features"}]}. Pixels are
/// given to 1/100, times to 1/1000 ms, the homography (row by row, view px -> scene px) in full.
[[nodiscard]] Json to_json(const RecognitionResult& result, const std::string& image);

/// {"object", "view", "confidence", "probability", "log10_false_alarms", "inliers",
/// "features_in_area", "homography", "outline", "box", and, when there are any, "alternatives"}.
[[nodiscard]] Json to_json(const Detection& detection);

/// {"object", "found", "stage", "reason", "option", "scene_features", "similar", "matched",
/// "largest_bin", "clusters", and, when there was a pose, "best": a detection}.
[[nodiscard]] Json to_json(const Explanation& explanation);

/// {"image", "error"}: the picture could not be read.
[[nodiscard]] Json error_json(const std::string& image, const std::string& error);

/// One line without its end; bytes that are not UTF-8 (file names may hold them) become U+FFFD.
[[nodiscard]] std::string to_line(const Json& json);

}  // namespace posevote
