#include "posevote/render/annotate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "posevote/render/label_font.hpp"

namespace posevote {
namespace {

constexpr int fraction_bits = 3;  // of the coordinates handed to OpenCV
constexpr float far_px = 1e5F;    // beyond it coordinates are clamped: OpenCV draws with integers

using Polygon = std::vector<cv::Point>;

cv::Mat to_bgr(const cv::Mat& image) {
  cv::Mat bytes, bgr;
  if (image.empty()) return bgr;
  image.convertTo(bytes, CV_8U, image.depth() == CV_16U ? 1.0 / 256 : 1.0);
  if (bytes.channels() == 1) cv::cvtColor(bytes, bgr, cv::COLOR_GRAY2BGR);
  if (bytes.channels() == 4) cv::cvtColor(bytes, bgr, cv::COLOR_BGRA2BGR);
  return bytes.channels() == 3 ? bytes : bgr;
}

cv::Point fixed_point(const cv::Point2f& point) {
  const auto fix = [](float value) {
    const float bounded = std::isfinite(value) ? std::clamp(value, -far_px, far_px) : 0.F;
    return static_cast<int>(std::lround(bounded * (1 << fraction_bits)));
  };
  return {fix(point.x), fix(point.y)};
}

Polygon fixed_polygon(const std::vector<cv::Point2f>& outline) {
  Polygon polygon;
  for (const cv::Point2f& point : outline) polygon.push_back(fixed_point(point));
  return polygon;
}

std::string label_text(const Detection& detection) {
  return names_of(detection) + "  " + sureness(detection);
}

bool is_light(const cv::Scalar& color) {
  return 0.114 * color[0] + 0.587 * color[1] + 0.299 * color[2] > 140;
}

/// Draws in units that grow with the picture, and keeps labels apart.
class Painter {
 public:
  Painter(cv::Mat& image, const AnnotateOptions& options)
      : image_(image),
        options_(options),
        line_px_(std::max(1, static_cast<int>(std::lround(short_side() / 240)))),
        text_px_(std::clamp(static_cast<int>(std::lround(short_side() / 26)), 10, 200)),
        font_(options.font, text_px_) {}

  void frame(const UnknownRegion& region) {
    const cv::Rect box(region.box);
    cv::rectangle(image_, box, cv::Scalar::all(0), 2 * line_px_ + 1);
    cv::rectangle(image_, box, cv::Scalar::all(200), line_px_);
    const int pad = text_px_ / 3;
    font_.draw(image_, "?", {box.x + pad, box.y + text_px_ + pad}, cv::Scalar::all(255));
  }

  void fill(const Detection& detection) {
    if (!options_.fill || detection.outline.empty()) return;
    cv::Mat tinted = image_.clone();
    cv::fillPoly(tinted, std::vector<Polygon>{fixed_polygon(detection.outline)},
                 object_color(detection.object), cv::LINE_AA, fraction_bits);
    constexpr double tint = 0.18;
    cv::addWeighted(tinted, tint, image_, 1 - tint, 0, image_);
  }

  void outline(const Detection& detection) {
    if (detection.outline.empty()) return;
    const std::vector<Polygon> polygon{fixed_polygon(detection.outline)};
    cv::polylines(image_, polygon, true, cv::Scalar::all(0), 2 * line_px_ + 1, cv::LINE_AA,
                  fraction_bits);
    cv::polylines(image_, polygon, true, object_color(detection.object), 2 * line_px_ - 1,
                  cv::LINE_AA, fraction_bits);
  }

  void points(const Detection& detection) {
    if (!options_.points) return;
    const int radius = std::max(1, line_px_) << fraction_bits;
    for (const MatchedPoint& match : detection.matches) {
      const cv::Point centre = fixed_point(match.scene);
      cv::circle(image_, centre, radius + (1 << fraction_bits), cv::Scalar::all(0), cv::FILLED,
                 cv::LINE_AA, fraction_bits);
      cv::circle(image_, centre, radius, object_color(detection.object), cv::FILLED, cv::LINE_AA,
                 fraction_bits);
    }
  }

  void label(const Detection& detection) {
    const std::string text = label_text(detection);
    const int pad = text_px_ / 3;
    cv::Rect box(0, 0, font_.width_px(text) + 2 * pad, text_px_ + pad);
    box.x = place(detection.box.x, image_.cols - box.width);
    box.y = place(detection.box.y - box.height, image_.rows - box.height);
    while (overlaps(box) && box.y + 2 * box.height <= image_.rows) box.y += box.height;
    taken_.push_back(box);
    const cv::Scalar color = object_color(detection.object);
    cv::rectangle(image_, box, color, cv::FILLED);
    font_.draw(image_, text, {box.x + pad, box.y + box.height - pad},
               cv::Scalar::all(is_light(color) ? 0 : 255));
  }

 private:
  [[nodiscard]] double short_side() const { return std::min(image_.cols, image_.rows); }

  /// `wanted`, or the nearest place inside the picture.
  static int place(double wanted, int largest) {
    if (!std::isfinite(wanted)) return 0;
    return static_cast<int>(std::clamp(wanted, 0.0, static_cast<double>(std::max(largest, 0))));
  }

  [[nodiscard]] bool overlaps(const cv::Rect& box) const {
    return std::ranges::any_of(taken_,
                               [&](const cv::Rect& other) { return !(box & other).empty(); });
  }

  cv::Mat& image_;
  const AnnotateOptions& options_;
  int line_px_;
  int text_px_;
  LabelFont font_;
  std::vector<cv::Rect> taken_;
};

}  // namespace

std::string names_of(const Detection& detection) {
  std::string names = detection.object;
  for (const std::string& other : detection.alternatives) names += " or " + other;
  return names;
}

std::string sureness(const Detection& detection) {
  const double share = detection.probability > 0 ? detection.probability : detection.confidence;
  return share > 0.99 ? "> 99 %" : std::to_string(std::lround(100 * share)) + " %";
}

cv::Scalar object_color(const std::string& name) {
  // Hues far apart from each other, readable on most pictures.
  static const std::array<cv::Scalar, 10> colors{{{60, 180, 75},
                                                  {48, 130, 245},
                                                  {200, 60, 230},
                                                  {25, 225, 255},
                                                  {240, 190, 70},
                                                  {75, 25, 230},
                                                  {212, 190, 250},
                                                  {180, 30, 145},
                                                  {60, 245, 210},
                                                  {200, 130, 0}}};
  std::uint32_t hash = 2166136261U;  // FNV-1a: the same on every machine
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return colors[hash % colors.size()];
}

cv::Mat annotate(const cv::Mat& image, const RecognitionResult& result,
                 const AnnotateOptions& options) {
  cv::Mat annotated = to_bgr(image);
  if (annotated.empty()) return annotated;
  Painter painter(annotated, options);
  for (const UnknownRegion& region : result.unknown) painter.frame(region);
  for (const Detection& detection : result.detections) painter.fill(detection);
  for (const Detection& detection : result.detections) painter.points(detection);
  for (const Detection& detection : result.detections) painter.outline(detection);
  for (const Detection& detection : result.detections) painter.label(detection);
  return annotated;
}

}  // namespace posevote
