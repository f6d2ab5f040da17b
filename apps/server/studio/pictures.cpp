#include "studio/pictures.hpp"

#include <charconv>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "http/problem.hpp"
#include "posevote/image/image_header.hpp"
#include "posevote/image/read_image.hpp"
#include "posevote/teach/segment.hpp"

namespace posevote::server {

cv::Mat decode_within(const Bytes& encoded, const Limits& limits) {
  ReadOptions options;
  options.max_megapixels = limits.megapixels;
  return decode_image(encoded, "picture", options);
}

SentPicture decode_sent(Bytes encoded, const Limits& limits) {
  SentPicture picture;
  picture.image = decode_within(encoded, limits);
  picture.encoded = std::move(encoded);
  picture.source = "upload";
  return picture;
}

Bytes take_picture(Body& body) {
  const auto part = body.parts.find("picture");
  return std::move(part == body.parts.end() ? body.raw : part->second);
}

SentPicture from_frame(const LiveFrame& frame) {
  SentPicture picture;
  picture.encoded = encode_jpeg(frame.image(), 95);
  picture.image = cv::imdecode(picture.encoded, cv::IMREAD_COLOR);
  picture.source = frame.source();
  return picture;
}

Bytes encode_png(const cv::Mat& image) {
  Bytes data;
  if (!cv::imencode(".png", image, data, {cv::IMWRITE_PNG_COMPRESSION, 1}))
    throw Error(ErrorCode::io, "a picture could not be encoded");
  return data;
}

Response picture_response(const Request& request, const Bytes& encoded, JobSlots& jobs,
                          const Limits& limits) {
  Response response;
  if (const auto width = parse_number(request, "width", 16, 2048)) {
    const JobSlots::Slot slot(jobs);
    const cv::Mat image = to_bgr8(decode_within(encoded, limits));
    response =
        bytes_response("image/jpeg", encode_jpeg(reduced_to(image, static_cast<int>(*width)), 85));
  } else {
    const auto header = parse_image_header(encoded.data(), encoded.size());
    response = bytes_response("image/" + (header ? header->format : "unknown"), encoded);
  }
  // Ids may be used again after a deletion, and only by whom the token was shown.
  response.headers.emplace("Cache-Control", "private, no-cache");
  return response;
}

std::optional<double> parse_number(const Request& request, const char* name, double min,
                                   double max) {
  const auto text = request.find(name);
  if (!text) return std::nullopt;
  double value = 0;
  const char* end = text->data() + text->size();
  const auto [last, error] = std::from_chars(text->data(), end, value);
  if (error != std::errc() || last != end || !(value >= min && value <= max)) {
    std::ostringstream sentence;
    sentence << name << " must be a number from " << min << " to " << max;
    throw invalid(sentence.str());
  }
  return value;
}

std::optional<cv::Rect> parse_rectangle(const Request& request, const char* name) {
  const auto text = request.find(name);
  if (!text) return std::nullopt;
  double values[4];
  const char* at = text->data();
  const char* end = at + text->size();
  for (int i = 0; i < 4; ++i) {
    const auto [last, error] = std::from_chars(at, end, values[i]);
    const bool rest = i < 3 ? last != end && *last == ',' : last == end;
    if (error != std::errc() || !rest || !(std::abs(values[i]) < 1e6) || (i > 1 && values[i] < 1))
      throw invalid(std::string(name) + " must be x,y,width,height in pixels");
    at = last + 1;
  }
  return cv::Rect(cvRound(values[0]), cvRound(values[1]), cvRound(values[2]), cvRound(values[3]));
}

bool parse_flag(const Request& request, const char* name) {
  const std::string text = request.find(name).value_or("false");
  if (text != "true" && text != "false")
    throw invalid(std::string(name) + " must be true or false");
  return text == "true";
}

}  // namespace posevote::server
