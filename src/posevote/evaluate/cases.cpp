#include "posevote/evaluate/cases.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/table.hpp"
#include "posevote/feature/features.hpp"

namespace posevote {
namespace {

const Detection& detection_of(const Case& item) {
  return item.outcome->result.detections[static_cast<std::size_t>(item.detection)];
}

const DatasetTest& test_of(const Case& item) {
  return item.dataset->tests[item.outcome->test];
}

const TruthObject& truth_of(const Case& item) {
  return test_of(item).objects[static_cast<std::size_t>(item.truth)];
}

std::string base64(const std::vector<unsigned char>& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    const unsigned group =
        bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    text += digits[group >> 18];
    text += digits[group >> 12 & 63];
    text += left > 1 ? digits[group >> 6 & 63] : '=';
    text += left > 2 ? digits[group & 63] : '=';
  }
  return text;
}

cv::Mat to_8bit_bgr(const cv::Mat& picture) {
  cv::Mat eight = picture, colour;
  if (picture.depth() == CV_16U) picture.convertTo(eight, CV_8U, 1.0 / 256);
  if (eight.channels() == 1) cv::cvtColor(eight, colour, cv::COLOR_GRAY2BGR);
  if (eight.channels() == 4) cv::cvtColor(eight, colour, cv::COLOR_BGRA2BGR);
  return colour.empty() ? eight : colour;
}

std::string polygon(const std::vector<cv::Point2f>& outline, const std::string& css) {
  std::string points;
  for (const cv::Point2f& point : outline)
    points += (points.empty() ? "" : " ") + fixed(point.x, 1) + "," + fixed(point.y, 1);
  return "<polygon class=\"" + css + "\" points=\"" + points + "\"/>";
}

std::string rectangle(const cv::Rect2d& box, const std::string& css) {
  return "<rect class=\"" + css + "\" x=\"" + fixed(box.x, 1) + "\" y=\"" + fixed(box.y, 1) +
         "\" width=\"" + fixed(box.width, 1) + "\" height=\"" + fixed(box.height, 1) + "\"/>";
}

std::string caption(const Case& item) {
  std::string text;
  if (item.detection >= 0) {
    const Detection& d = detection_of(item);
    text += "<b>" + escape_html(d.object) + "</b> claimed";
    if (item.truth >= 0) text += " where <b>" + escape_html(truth_of(item).name) + "</b> is";
    text +=
        "<br>" + std::to_string(d.inliers) + " inliers of " + std::to_string(d.features_in_area) +
        " features, confidence " + percent(d.confidence, 0) + ", significance " +
        fixed(-d.log10_false_alarms, 1) +
        (item.truth >= 0
             ? ", overlap " +
                   fixed(
                       item.outcome->score.judgements[static_cast<std::size_t>(item.detection)].iou,
                       2)
             : "") +
        "<br>taught view " + escape_html(d.view);
  } else {
    const TruthObject& truth = truth_of(item);
    text += "<b>" + escape_html(truth.name) + "</b> missed<br>" + percent(truth.visible, 0) +
            " visible" +
            (std::isnan(truth.yaw_deg) ? "" : ", yaw " + fixed(truth.yaw_deg, 0) + "°");
  }
  const DatasetTest& test = test_of(item);
  return text + "<br><span class=\"soft\">" + escape_html(test.image.generic_string()) +
         (test.group.empty() ? "" : ", " + escape_html(test.group)) + "</span>";
}

}  // namespace

std::vector<Case> cases_of(const Dataset& dataset, const std::vector<TestOutcome>& outcomes,
                           Verdict verdict) {
  std::vector<Case> cases;
  for (const TestOutcome& outcome : outcomes)
    for (std::size_t i = 0; i < outcome.score.judgements.size(); ++i)
      if (outcome.score.judgements[i].verdict == verdict)
        cases.push_back(
            {&dataset, &outcome, static_cast<int>(i), outcome.score.judgements[i].truth});
  std::ranges::stable_sort(cases, [](const Case& a, const Case& b) {
    const Detection &first = detection_of(a), &second = detection_of(b);
    if (first.log10_false_alarms != second.log10_false_alarms)
      return first.log10_false_alarms < second.log10_false_alarms;
    return first.probability > second.probability;
  });
  return cases;
}

std::vector<Case> missed_cases(const Dataset& dataset, const std::vector<TestOutcome>& outcomes) {
  std::vector<Case> cases;
  for (const TestOutcome& outcome : outcomes)
    for (const int missed : outcome.score.missed) cases.push_back({&dataset, &outcome, -1, missed});
  std::ranges::stable_sort(cases, [](const Case& a, const Case& b) {
    const TruthObject &first = truth_of(a), &second = truth_of(b);
    if (first.visible != second.visible) return first.visible > second.visible;
    return first.box.area() > second.box.area();
  });
  return cases;
}

std::string jpeg_data_url(const cv::Mat& picture, int quality) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality}))
    throw Error(ErrorCode::unsupported, "this OpenCV cannot write JPEG pictures");
  return "data:image/jpeg;base64," + base64(bytes);
}

std::string case_figure(const Case& item, int picture_width, int jpeg_quality) {
  cv::Mat picture;
  try {
    picture = to_8bit_bgr(read_dataset_image(*item.dataset, test_of(item).image));
  } catch (const Error&) {
    return "";
  }
  const cv::Size size = picture.size();
  if (size.width > picture_width) {
    const double factor = static_cast<double>(picture_width) / size.width;
    cv::resize(picture, picture, cv::Size(), factor, factor, cv::INTER_AREA);
  }
  std::string overlay;
  if (item.truth >= 0) overlay += rectangle(truth_of(item).box, "truth");
  if (item.detection >= 0) overlay += polygon(detection_of(item).outline, "claim");
  return "<figure><div class=\"picture\"><img alt=\"" +
         escape_html(test_of(item).image.generic_string()) + "\" src=\"" +
         jpeg_data_url(picture, jpeg_quality) + "\"><svg viewBox=\"0 0 " +
         std::to_string(size.width) + " " + std::to_string(size.height) + "\">" + overlay +
         "</svg></div><figcaption>" + caption(item) + "</figcaption></figure>\n";
}

}  // namespace posevote
