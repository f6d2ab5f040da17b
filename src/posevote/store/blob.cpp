#include "posevote/store/blob.hpp"

#include <bit>
#include <cmath>
#include <cstring>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

static_assert(std::endian::native == std::endian::little,
              "blobs are written as they lie in memory");

constexpr std::size_t keypoint_bytes = 5 * sizeof(float) + 1;
constexpr std::size_t point_bytes = 2 * sizeof(float);
constexpr int max_dimension = 4096;

[[noreturn]] void fail(const std::string& reason) {
  throw Error(ErrorCode::database_unusable, "a view in the database is damaged: " + reason);
}

void check_finite(const float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    if (!std::isfinite(values[i])) fail("a number in it is not finite");
}

}  // namespace

Blob encode_keypoints(const Features& features) {
  Blob blob(features.size() * keypoint_bytes);
  std::uint8_t* out = blob.data();
  for (const Keypoint& point : features.keypoints) {
    const float values[] = {point.x, point.y, point.scale, point.angle, point.response};
    std::memcpy(out, values, sizeof values);
    std::memcpy(out + sizeof values, &point.laplacian, 1);
    out += keypoint_bytes;
  }
  return blob;
}

Blob encode_descriptors(const Features& features) {
  const cv::Mat& rows = features.descriptors;
  if (rows.empty()) return {};
  CV_Assert(rows.type() == CV_32F && rows.isContinuous());
  return {rows.datastart, rows.datastart + rows.total() * sizeof(float)};
}

Blob encode_points(const std::vector<cv::Point2f>& points) {
  Blob blob(points.size() * point_bytes);
  if (!points.empty()) std::memcpy(blob.data(), points.data(), blob.size());
  return blob;
}

Features decode_features(BlobView keypoints, BlobView descriptors, int dimension) {
  const std::size_t count = keypoints.size / keypoint_bytes;
  if (keypoints.size % keypoint_bytes != 0) fail("its key points are cut off");
  if (dimension < (count == 0 ? 0 : 1) || dimension > max_dimension)
    fail("its descriptors have a senseless length");
  if (descriptors.size != count * static_cast<std::size_t>(dimension) * sizeof(float))
    fail("it has not one descriptor for each key point");
  Features features;
  if (count == 0) return features;
  features.keypoints.resize(count);
  const auto* in = static_cast<const std::uint8_t*>(keypoints.data);
  for (Keypoint& point : features.keypoints) {
    float values[5];
    std::memcpy(values, in, sizeof values);
    check_finite(values, 5);
    point = {values[0], values[1], values[2], values[3], values[4], 0};
    std::memcpy(&point.laplacian, in + sizeof values, 1);
    in += keypoint_bytes;
  }
  features.descriptors.create(static_cast<int>(count), dimension, CV_32F);
  std::memcpy(features.descriptors.data, descriptors.data, descriptors.size);
  check_finite(features.descriptors.ptr<float>(), features.descriptors.total());
  return features;
}

std::vector<cv::Point2f> decode_points(BlobView points) {
  if (points.size % point_bytes != 0) fail("its outline is cut off");
  std::vector<cv::Point2f> decoded(points.size / point_bytes);
  if (!decoded.empty()) std::memcpy(decoded.data(), points.data, points.size);
  for (const cv::Point2f& point : decoded) check_finite(&point.x, 1), check_finite(&point.y, 1);
  return decoded;
}

namespace {

struct PatchHeader {
  std::int32_t width, height;
  double scale, x, y;
};
constexpr int max_patch_side = 4096;

}  // namespace

Blob encode_patch(const Patch& patch) {
  if (patch.empty()) return {};
  CV_Assert(patch.pixels.type() == CV_8UC3 && patch.mask.type() == CV_8U &&
            patch.mask.size() == patch.pixels.size());
  const PatchHeader header{patch.pixels.cols, patch.pixels.rows, patch.scale, patch.corner.x,
                           patch.corner.y};
  const cv::Mat pixels = patch.pixels.isContinuous() ? patch.pixels : patch.pixels.clone();
  const cv::Mat mask = patch.mask.isContinuous() ? patch.mask : patch.mask.clone();
  Blob blob(sizeof header + 4 * pixels.total());
  std::memcpy(blob.data(), &header, sizeof header);
  std::memcpy(blob.data() + sizeof header, pixels.data, 3 * pixels.total());
  std::memcpy(blob.data() + sizeof header + 3 * pixels.total(), mask.data, mask.total());
  return blob;
}

Patch decode_patch(BlobView bytes) {
  if (bytes.size == 0) return {};
  PatchHeader header{};
  if (bytes.size < sizeof header) fail("its patch is cut off");
  std::memcpy(&header, bytes.data, sizeof header);
  const bool sane = header.width > 0 && header.height > 0 && header.width <= max_patch_side &&
                    header.height <= max_patch_side && header.scale > 0 &&
                    std::isfinite(header.scale) && std::isfinite(header.x) &&
                    std::isfinite(header.y);
  const std::size_t pixels =
      static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
  if (!sane || bytes.size != sizeof header + 4 * pixels) fail("its patch is cut off");
  const auto* data = static_cast<const std::uint8_t*>(bytes.data) + sizeof header;
  Patch patch;
  patch.scale = header.scale;
  patch.corner = {header.x, header.y};
  patch.pixels.create(header.height, header.width, CV_8UC3);
  patch.mask.create(header.height, header.width, CV_8U);
  std::memcpy(patch.pixels.data, data, 3 * pixels);
  std::memcpy(patch.mask.data, data + 3 * pixels, pixels);
  return patch;
}

}  // namespace posevote
