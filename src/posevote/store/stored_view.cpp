#include "posevote/store/stored_view.hpp"

#include <chrono>
#include <ctime>
#include <opencv2/imgproc.hpp>

#include "posevote/image/read_image.hpp"
#include "posevote/store/content_hash.hpp"

namespace posevote {
namespace {

/// 8-bit BGR of whatever was taught.
cv::Mat to_bgr(const cv::Mat& image) {
  cv::Mat bytes = image, colour;
  if (image.depth() == CV_16U) image.convertTo(bytes, CV_8U, 1.0 / 256);
  if (bytes.channels() == 3) return bytes;
  cv::cvtColor(bytes, colour, bytes.channels() == 1 ? cv::COLOR_GRAY2BGR : cv::COLOR_BGRA2BGR);
  return colour;
}

/// What `decode` makes of stored bytes.
template <class Decode>
auto unless_damaged(const Decode& decode, const std::string& location) {
  try {
    return decode();
  } catch (const Error& error) {
    throw_database_error(ErrorCode::database_unusable, location,
                         std::string("is damaged: ") + error.what());
  }
}

/// Throws Error{unreadable_image}; `name` stands for the pictures in messages.
void decode_pictures(View& view, const Blob& picture, const Blob& mask, const std::string& name) {
  view.picture = to_bgr(decode_image(picture, name));
  if (!mask.empty()) view.mask = decode_image(mask, name);
}

Patch patch_of(const View& view, const Blob& picture, const Blob& mask) {
  View read;
  try {
    decode_pictures(read, picture, mask, "a view");
  } catch (const Error& error) {
    if (error.code() != ErrorCode::unreadable_image) throw;
    return {};
  }
  if (read.mask.empty()) {
    const std::vector<cv::Point> polygon(view.outline.begin(), view.outline.end());
    read.mask = cv::Mat::zeros(read.picture.size(), CV_8U);
    cv::fillPoly(read.mask, std::vector<std::vector<cv::Point>>{polygon}, cv::Scalar(255));
  }
  return read.mask.size() == read.picture.size() ? make_patch(read.picture, read.mask) : Patch();
}

}  // namespace

void throw_database_error(ErrorCode code, const std::string& location, const std::string& reason) {
  throw Error(code, "database '" + location + "' " + reason);
}

View checked_view(const std::function<View()>& read, const std::string& identity,
                  const std::string& signature, const std::string& location) {
  View view = unless_damaged(read, location);
  if (content_hash(view, identity, signature) != view.hash)
    throw_database_error(ErrorCode::database_unusable, location,
                         "is damaged: view " + view.id +
                             " of an object does not hold what was stored; make it again: posevote "
                             "objects rebuild");
  return view;
}

void check_picture(const TaughtView& view, const std::string& identity, const std::string& number,
                   const std::string& location) {
  if (identity_hash(view) != identity)
    throw_database_error(ErrorCode::database_unusable, location,
                         "is damaged: the picture of view " + number +
                             " of an object is not the one that was stored; remove that view and "
                             "teach it again");
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

std::string identity_hash(const Impostor& impostor) {
  check_features(impostor.features);
  if (impostor.picture.empty())
    throw Error(ErrorCode::invalid_argument, "an impostor cannot be stored without its picture");
  ContentHash hash;
  hash.add(impostor.picture);
  return hash.hex();
}

Blob patch_blob(const View& view, const Blob& picture, const Blob& mask) {
  return encode_patch(patch_of(view, picture, mask));
}

void halve_descriptors(Features& features) {
  if (features.empty()) return;
  cv::Mat halves;
  features.descriptors.convertTo(halves, CV_16F);
  features.descriptors = halves;
}

void add_pictures(View& view, BlobView stored_patch, bool pictures, const FetchPictures& fetch,
                  const std::string& location) {
  view.patch = unless_damaged([&] { return decode_patch(stored_patch); }, location);
  if (!pictures && !view.patch.empty()) return;
  const auto [picture, mask] = fetch();
  if (view.patch.empty()) view.patch = patch_of(view, picture, mask);
  if (pictures) decode_pictures(view, picture, mask, location);
}

std::shared_ptr<const View> ViewCache::get(
    const std::string& key, const std::function<std::shared_ptr<const View>()>& make) {
  std::weak_ptr<const View>& cached = views_[key];
  std::shared_ptr<const View> view = cached.lock();
  if (!view) cached = view = make();
  return view;
}

void ViewCache::tidy() {
  std::erase_if(views_, [](const auto& entry) { return entry.second.expired(); });
}

}  // namespace posevote
