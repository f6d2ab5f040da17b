// A view as it is kept: with the pictures it came from, so that its features can be made again.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "posevote/model/view.hpp"

namespace posevote {

/// Where a view comes from.
struct Provenance {
  std::string source;     ///< file or camera, as the user named it
  std::string taught_at;  ///< UTC, ISO 8601; empty: the store writes the present time
  std::string version;    ///< of the program that taught it
};

struct TaughtView {
  View view;                          ///< `id` and `hash` are given by the store
  std::vector<std::uint8_t> picture;  ///< encoded, as given; empty: `view.picture` as PNG
  std::vector<std::uint8_t> mask;     ///< PNG; empty: `view.mask` as PNG
  std::string method;                 ///< how the object was found: "background", "mask", ...
  Provenance provenance;
};

/// A picture that shows none of the objects, with its features: a false detection or the
/// surroundings.
struct Impostor {
  std::string id;  ///< given by the store
  Features features;
  std::vector<std::uint8_t> picture;  ///< encoded
  Provenance provenance;
};

/// A copy with picture and mask encoded. Throws Error{invalid_argument} when there is no picture,
/// the outline has fewer than 3 points, or descriptors and key points do not belong together.
[[nodiscard]] TaughtView complete_view(TaughtView view);

/// Throws Error{invalid_argument}: see `complete_view`.
void check_features(const Features& features);

/// What was taught - picture, mask and yaw: equal for the same picture taught twice. 64 hex digits.
[[nodiscard]] std::string identity_hash(const TaughtView& view);

/// All that recognition reads of the view, under this feature signature. 64 hex digits.
[[nodiscard]] std::string content_hash(const View& view, const std::string& identity,
                                       const std::string& signature);

/// Share of the picture that the object covers: by the mask, else by the outline.
[[nodiscard]] double coverage(const View& view);

}  // namespace posevote
