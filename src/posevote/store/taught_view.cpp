#include "posevote/store/taught_view.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"
#include "posevote/store/blob.hpp"
#include "posevote/store/content_hash.hpp"

namespace posevote {
namespace {

[[noreturn]] void fail(const std::string& reason) {
  throw Error(ErrorCode::invalid_argument, "a view cannot be stored: " + reason);
}

std::vector<std::uint8_t> encode_png(const cv::Mat& image) {
  std::vector<std::uint8_t> data;
  if (!image.empty()) cv::imencode(".png", image, data);
  return data;
}

}  // namespace

void check_features(const Features& features) {
  const cv::Mat& descriptors = features.descriptors;
  if (descriptors.rows != static_cast<int>(features.size()))
    fail("it has not one descriptor for each key point");
  if (!descriptors.empty() && (descriptors.type() != CV_32F || !descriptors.isContinuous()))
    fail("its descriptors are not continuous rows of 32-bit floats");
}

TaughtView complete_view(TaughtView view) {
  if (view.view.outline.size() < 3) fail("its outline has fewer than 3 points");
  if (view.view.image_size.empty()) fail("it has no size");
  check_features(view.view.features);
  if (view.picture.empty()) view.picture = encode_png(view.view.picture);
  if (view.picture.empty()) fail("it has no picture");
  if (view.mask.empty()) view.mask = encode_png(view.view.mask);
  return view;
}

std::string identity_hash(const TaughtView& view) {
  ContentHash hash;
  hash.add(view.picture);
  hash.add(view.mask);
  hash.add(std::isnan(view.view.yaw_deg) ? "" : std::to_string(view.view.yaw_deg));
  return hash.hex();
}

std::string content_hash(const View& view, const std::string& identity,
                         const std::string& signature) {
  ContentHash hash;
  hash.add(identity);
  hash.add(signature);
  hash.add(std::to_string(view.image_size.width) + "x" + std::to_string(view.image_size.height));
  hash.add(encode_points(view.outline));
  hash.add(encode_points({view.centre}));
  hash.add(encode_keypoints(view.features));
  // As encode_descriptors has them, but not copied: these are nearly all bytes of a view.
  const cv::Mat& rows = view.features.descriptors;
  CV_Assert(rows.empty() || (rows.type() == CV_32F && rows.isContinuous()));
  hash.add(rows.data, rows.total() * sizeof(float));
  return hash.hex();
}

double coverage(const View& view) {
  const double area =
      view.mask.empty() ? cv::contourArea(view.outline) : cv::countNonZero(view.mask);
  return area / view.image_size.area();
}

}  // namespace posevote
