#include "live/frame.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"

namespace posevote::server {

Bytes encode_jpeg(const cv::Mat& image, int quality) {
  Bytes data;
  if (!cv::imencode(".jpg", image, data, {cv::IMWRITE_JPEG_QUALITY, quality}))
    throw Error(ErrorCode::io, "a picture could not be encoded");
  return data;
}

cv::Mat reduced_to(const cv::Mat& image, int width) {
  if (image.cols <= width) return image;
  cv::Mat smaller;
  const int height = std::max(1, cvRound(image.rows * (width / static_cast<double>(image.cols))));
  cv::resize(image, smaller, {width, height}, 0, 0, cv::INTER_AREA);
  return smaller;
}

const Bytes& LiveFrame::stream_jpeg() const {
  std::call_once(once_, [this] {
    jpeg_ = encode_jpeg(reduced_to(image_, options_.stream_width), options_.stream_quality);
  });
  return jpeg_;
}

}  // namespace posevote::server
