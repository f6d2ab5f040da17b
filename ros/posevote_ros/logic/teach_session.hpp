// Teaching step by step: what the Teach action does, without any ROS.
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "logic/scene_watch.hpp"
#include "posevote/teach/teacher.hpp"

namespace posevote::logic {

/// What is to be taught, and how.
struct Lesson {
  std::string object;
  std::string method = "background";  ///< "background", "whole" or "box"
  cv::Rect box;                       ///< px, with method "box"
  int views = 1;                      ///< to be taken from the camera
  double first_yaw_deg = 0;           ///< anticlockwise, as seen from above
  double turn_deg = 0;                ///< from view to view; 0: turns are not known
  bool manual = false;                ///< take pictures on `capture` only
};

/// Throws Error{invalid_argument} that says what is wrong with it.
void check_lesson(const Lesson& lesson);

/// What became of a picture that a view was to be made from.
struct TaughtPicture {
  bool added = true;  ///< false: the same view was there already
  int features = 0;
  cv::Mat mask;                     ///< CV_8U, the object's pixels
  std::vector<std::string> advice;  ///< whole sentences; empty: a good view
};

/// Makes a view and keeps it; throws Error{unusable_view} with advice when none can be made.
using TeachView = std::function<TaughtPicture(const ViewSource& source)>;

struct TeachProgress {
  std::string step;         ///< "background", "object", "turn" or "done"
  std::string instruction;  ///< to the person who holds the object
  int views_taken = 0, views_known = 0, views_refused = 0, views_wanted = 0;
  std::vector<double> yaws_deg;  ///< of the views taken; NaN: not known
  int features = 0;              ///< of the last view
  std::vector<std::string> advice;
  cv::Mat preview;  ///< BGR 8-bit: the last picture, what is not object darkened
};

/// Takes views from a camera's pictures. With method "background" first the empty scene, as soon as
/// nothing moves; then, each time something has changed and nothing moves any more, a view. A
/// picture that no view can be made from is refused with advice, and the next change is waited for.
/// Not thread-safe.
class TeachSession {
 public:
  /// Throws as `check_lesson`.
  TeachSession(const Lesson& lesson, const WatchOptions& options, TeachView teach);

  /// The next picture, taken at `time_s`. True when there is progress to report. Errors of
  /// `teach` other than unusable_view pass through.
  bool offer(const cv::Mat& picture, double time_s);

  /// The next picture is taken, whatever moves.
  void capture() { capture_ = true; }

  [[nodiscard]] bool finished() const { return progress_.step == "done"; }
  [[nodiscard]] const TeachProgress& progress() const { return progress_; }

 private:
  [[nodiscard]] bool is_the_moment() const;
  void take(const cv::Mat& picture);
  void go_to(const std::string& step);

  Lesson lesson_;
  SceneWatch watch_;
  TeachView teach_;
  cv::Mat background_;
  TeachProgress progress_;
  bool capture_ = false;
};

/// Teaches from pictures that are there already (`background`: with that method). `report` is
/// called after each; when it returns false, the rest is left out.
TeachProgress teach_pictures(const Lesson& lesson, const std::vector<cv::Mat>& pictures,
                             const cv::Mat& background, const TeachView& teach,
                             const std::function<bool(const TeachProgress&)>& report);

}  // namespace posevote::logic
