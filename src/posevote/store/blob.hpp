// Key points, descriptors and polygons as bytes: little-endian, packed, the same in every backend.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/feature/features.hpp"
#include "posevote/model/patch.hpp"

namespace posevote {

using Blob = std::vector<std::uint8_t>;

/// Bytes that somebody else owns, e.g. a column of a database row.
struct BlobView {
  const void* data = nullptr;
  std::size_t size = 0;
};

/// 21 bytes each: x, y, scale, angle, response as 32-bit floats, the Laplacian's sign as int8.
[[nodiscard]] Blob encode_keypoints(const Features& features);
/// 32-bit floats, row by row.
[[nodiscard]] Blob encode_descriptors(const Features& features);
/// x, y as 32-bit floats.
[[nodiscard]] Blob encode_points(const std::vector<cv::Point2f>& points);

/// Width and height as int32, scale and corner as 64-bit floats, then the pixels and the mask row
/// by row. Empty for an empty patch.
[[nodiscard]] Blob encode_patch(const Patch& patch);

/// Throws Error{database_unusable} before anything is allocated when the sizes do not fit each
/// other or `dimension` is not in [1, 4096] (0 when there are no features), and for values that are
/// not finite.
[[nodiscard]] Features decode_features(BlobView keypoints, BlobView descriptors, int dimension);
/// Throws Error{database_unusable}: not a multiple of 8 bytes, not finite.
[[nodiscard]] std::vector<cv::Point2f> decode_points(BlobView points);
/// Throws Error{database_unusable}: sizes that do not fit, values that are not finite.
[[nodiscard]] Patch decode_patch(BlobView bytes);

}  // namespace posevote
