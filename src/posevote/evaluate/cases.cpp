#include "posevote/evaluate/cases.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/table.hpp"
#include "posevote/feature/features.hpp"
#include "posevote/teach/segment.hpp"

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

std::string dots(const std::vector<cv::Point2f>& points, double radius, const std::string& css) {
  std::string text;
  for (const cv::Point2f& point : points)
    text += "<circle class=\"" + css + "\" cx=\"" + fixed(point.x, 0) + "\" cy=\"" +
            fixed(point.y, 0) + "\" r=\"" + fixed(radius, 1) + "\"/>";
  return text;
}

std::vector<cv::Point2f> scene_points(const std::vector<MatchedPoint>& matches) {
  std::vector<cv::Point2f> points;
  points.reserve(matches.size());
  for (const MatchedPoint& match : matches) points.push_back(match.scene);
  return points;
}

// Matches, votes and strongest pose: what `posevote explain --draw` shows.
std::string evidence_svg(const Explanation& e, int picture_width) {
  const double unit = picture_width / 200.0;
  std::string svg =
      dots(e.vote_centres, unit, "vote") + dots(scene_points(e.matches), unit, "match");
  if (e.best)
    svg +=
        dots(scene_points(e.best->matches), 0.8 * unit, "agree") + polygon(e.best->outline, "pose");
  return "<g class=\"evidence\">" + svg + "</g>";
}

std::string fold(const Explanation& e) {
  std::string rows;
  for (const auto& [what, how_much] : stages_of(e))
    rows += "<tr><td>" + escape_html(what) + "</td><td>" + escape_html(how_much) + "</td></tr>";
  return "<details><summary>" + std::string(e.found ? "Found: " : "Not found: ") +
         escape_html(e.reason) + "</summary><table>" + rows + "</table>" +
         (e.option.empty() ? "" : "<p>option <code>" + escape_html(e.option) + "</code></p>") +
         "</details>";
}

// Empty when it cannot be read.
cv::Mat read_for_report(const Dataset& dataset, const std::filesystem::path& relative) try {
  return to_bgr8(read_dataset_image(dataset, relative));
} catch (const Error&) {
  return {};
}

std::string figure(const cv::Mat& picture, const std::string& name, const std::string& overlay,
                   const std::string& caption, const PictureOptions& options) {
  cv::Mat small = picture;
  const double factor = static_cast<double>(options.width) / picture.cols;
  if (factor < 1) cv::resize(picture, small, cv::Size(), factor, factor, cv::INTER_AREA);
  return "<figure><div class=\"picture\"><img alt=\"" + escape_html(name) + "\" src=\"" +
         jpeg_data_url(small, options.jpeg_quality) + "\"><svg viewBox=\"0 0 " +
         std::to_string(picture.cols) + " " + std::to_string(picture.rows) + "\">" + overlay +
         "</svg></div><figcaption>" + caption + "</figcaption></figure>\n";
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

std::vector<CaseList> worst_cases(const Evaluation& e) {
  std::vector<CaseList> lists{
      {"False positives, surest first", cases_of(e.dataset, e.outcomes, Verdict::false_positive)},
      {"False positives on " + e.negatives.name,
       cases_of(e.negatives, e.negative_outcomes, Verdict::false_positive)},
      {"Missed, best visible first", missed_cases(e.dataset, e.outcomes)},
      {"Named as the twin", cases_of(e.dataset, e.outcomes, Verdict::twin)}};
  std::erase_if(lists, [](const CaseList& list) { return list.cases.empty(); });
  return lists;
}

std::pair<std::filesystem::path, std::string> question_of(const Case& item) {
  return {item.dataset->path(test_of(item).image),
          item.detection >= 0 ? detection_of(item).object : truth_of(item).name};
}

std::string case_figure(const Case& item, const Explanation* explanation,
                        const PictureOptions& options) {
  const std::filesystem::path& file = test_of(item).image;
  const cv::Mat picture = read_for_report(*item.dataset, file);
  if (picture.empty()) return "";
  std::string overlay;
  if (explanation != nullptr) overlay += evidence_svg(*explanation, picture.cols);
  if (item.truth >= 0) overlay += rectangle(truth_of(item).box, "truth");
  if (item.detection >= 0) overlay += polygon(detection_of(item).outline, "claim");
  return figure(picture, file.generic_string(), overlay,
                caption(item) + (explanation != nullptr ? fold(*explanation) : ""), options);
}

std::string silhouette_figure(const Dataset& dataset, const SilhouetteCase& item,
                              const PictureOptions& options) {
  const cv::Mat picture = read_for_report(dataset, item.image);
  const cv::Mat truth = read_for_report(dataset, item.truth_mask);
  if (picture.empty() || truth.empty()) return "";
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(to_grey(truth) > 127, contours, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  std::string overlay;
  for (const auto& contour : contours)
    overlay += polygon({contour.begin(), contour.end()}, "truth");
  overlay += polygon(item.outline, "claim");
  return figure(picture, item.image, overlay,
                "<b>" + escape_html(item.object) + "</b> " +
                    (item.refused ? "refused" : "IoU " + fixed(item.fit.iou, 3)) +
                    "<br>taken wrongly " + percent(item.fit.wrong_share) + ", of it shadow " +
                    percent(item.fit.shadow_share) + "<br><span class=\"soft\">" +
                    escape_html(item.image) + "</span>",
                options);
}

}  // namespace posevote
