#include "logic/teach_session.hpp"

#include <cmath>

#include "posevote/core/error.hpp"
#include "posevote/store/object_name.hpp"

namespace posevote::logic {
namespace {

cv::Mat darken_surroundings(const cv::Mat& picture, const cv::Mat& mask) {
  cv::Mat preview = to_bgr8(picture);
  if (mask.size() != preview.size()) return preview;
  cv::Mat dark = preview * 0.3;
  preview.copyTo(dark, mask);
  return dark;
}

/// Makes the view number `lesson.first_yaw_deg + views so far` and enters what became of it.
void teach_one(const Lesson& lesson, const cv::Mat& picture, const cv::Mat& background, int number,
               const TeachView& teach, TeachProgress& progress) {
  ViewSource source;
  source.picture = picture;
  if (lesson.method == "background") source.background = background;
  if (lesson.method == "box") source.roi = lesson.box;
  if (lesson.turn_deg != 0)
    source.yaw_deg = std::fmod(lesson.first_yaw_deg + number * lesson.turn_deg, 360.0);
  progress.features = 0;
  try {
    const TaughtPicture taught = teach(source);
    ++(taught.added ? progress.views_taken : progress.views_known);
    progress.yaws_deg.push_back(source.yaw_deg);
    progress.features = taught.features;
    progress.advice = taught.advice;
    progress.preview = darken_surroundings(picture, taught.mask);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::unusable_view) throw;
    ++progress.views_refused;
    progress.advice = {error.what()};
    progress.preview = to_bgr8(picture);
  }
}

}  // namespace

void check_lesson(const Lesson& lesson) {
  check_object_name(lesson.object);
  if (lesson.method != "background" && lesson.method != "whole" && lesson.method != "box")
    throw Error(ErrorCode::invalid_argument,
                "there is no method '" + lesson.method + "'; use background, whole or box");
  if (lesson.method == "box" && lesson.box.empty())
    throw Error(ErrorCode::invalid_argument, "method 'box' needs a box with a width and a height");
  if (lesson.views < 1 || lesson.views > 1000)
    throw Error(ErrorCode::invalid_argument, "views must be 1 to 1000");
  if (!std::isfinite(lesson.first_yaw_deg) || !std::isfinite(lesson.turn_deg))
    throw Error(ErrorCode::invalid_argument, "turns must be numbers, in degrees");
}

TeachSession::TeachSession(const Lesson& lesson, const WatchOptions& options, TeachView teach)
    : lesson_(lesson), watch_(options), teach_(std::move(teach)) {
  check_lesson(lesson);
  progress_.views_wanted = lesson.views;
  go_to(lesson.method == "background" ? "background" : "object");
}

void TeachSession::go_to(const std::string& step) {
  progress_.step = step;
  const std::string when = lesson_.manual ? ", then call capture" : " and take your hands away";
  if (step == "background")
    progress_.instruction =
        lesson_.manual ? "Clear the scene, then call capture" : "Clear the scene and keep it still";
  else if (step == "object")
    progress_.instruction = "Show " + lesson_.object + when;
  else if (step == "turn")
    progress_.instruction = "Turn " + lesson_.object + when;
  else
    progress_.instruction = "Done";
}

bool TeachSession::is_the_moment() const {
  if (capture_) return true;
  return !lesson_.manual && watch_.at_rest() && watch_.has_changed();
}

bool TeachSession::offer(const cv::Mat& picture, double time_s) {
  if (finished()) return false;
  watch_.add(picture, time_s);
  if (!is_the_moment()) return false;
  capture_ = false;
  watch_.remember();
  take(picture);
  return true;
}

void TeachSession::take(const cv::Mat& picture) {
  progress_.advice.clear();
  if (progress_.step == "background") {
    background_ = picture.clone();
    progress_.preview = to_bgr8(picture);
    go_to("object");
    return;
  }
  const int number = progress_.views_taken + progress_.views_known;
  teach_one(lesson_, picture, background_, number, teach_, progress_);
  const int views = progress_.views_taken + progress_.views_known;
  if (views == number) return;  // refused: something has to change
  go_to(views == lesson_.views ? "done" : "turn");
}

TeachProgress teach_pictures(const Lesson& lesson, const std::vector<cv::Mat>& pictures,
                             const cv::Mat& background, const TeachView& teach,
                             const std::function<bool(const TeachProgress&)>& report) {
  check_lesson(lesson);
  if (lesson.method == "background" && background.empty())
    throw Error(ErrorCode::invalid_argument,
                "method 'background' needs a picture of the empty scene beside the pictures");
  TeachProgress progress;
  progress.step = "object";
  progress.views_wanted = static_cast<int>(pictures.size());
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    teach_one(lesson, pictures[i], background, static_cast<int>(i), teach, progress);
    if (i + 1 == pictures.size()) progress.step = "done";
    if (!report(progress)) break;
  }
  return progress;
}

}  // namespace posevote::logic
