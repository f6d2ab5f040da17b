#include "posevote/store/stored_view.hpp"

#include <chrono>
#include <ctime>
#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"
#include "posevote/image/read_image.hpp"

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

}  // namespace

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

void decode_pictures(View& view, const std::vector<std::uint8_t>& picture,
                     const std::vector<std::uint8_t>& mask, const std::string& name) {
  view.picture = to_bgr(decode_image(picture, name));
  if (!mask.empty()) view.mask = decode_image(mask, name);
}

Patch patch_of(const View& view, const std::vector<std::uint8_t>& picture,
               const std::vector<std::uint8_t>& mask) {
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
