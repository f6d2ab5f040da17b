// Results into messages and messages into requests: the field names are the same in both ROSes,
// only the types' namespaces differ. Headers are the caller's business.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "logic/object_recognition.hpp"
#include "logic/raw_image.hpp"
#include "logic/teach_session.hpp"
#include "posevote/render/annotate.hpp"

namespace posevote::logic {

/// `Image`: sensor_msgs/Image. The result shares the message's data.
template <class Image>
[[nodiscard]] RawImage view_of(const Image& message) {
  return {message.width,
          message.height,
          message.step,
          message.encoding,
          message.is_bigendian != 0,
          message.data.data(),
          message.data.size()};
}

template <class Image>
void fill_image(Image& message, const cv::Mat& picture) {
  const cv::Mat whole = picture.isContinuous() ? picture : picture.clone();
  message.width = static_cast<std::uint32_t>(whole.cols);
  message.height = static_cast<std::uint32_t>(whole.rows);
  message.encoding = encoding_of(whole);
  message.step = static_cast<std::uint32_t>(whole.step);
  message.data.assign(whole.ptr(), whole.ptr() + whole.total() * whole.elemSize());
}

/// `Point`: geometry_msgs/Point or Vector3.
template <class Point>
void fill_point(Point& message, const cv::Vec3d& p) {
  message.x = p[0];
  message.y = p[1];
  message.z = p[2];
}

template <class Quaternion>
void fill_quaternion(Quaternion& message, const cv::Matx33d& rotation) {
  const cv::Vec4d q = quaternion(rotation);
  message.x = q[0];
  message.y = q[1];
  message.z = q[2];
  message.w = q[3];
}

/// `PoseMessage`: geometry_msgs/Pose.
template <class PoseMessage>
void fill_pose(PoseMessage& message, const Pose& pose) {
  fill_point(message.position, pose.translation);
  fill_quaternion(message.orientation, pose.rotation);
}

/// `Message`: posevote_msgs/Detection.
template <class Message>
void fill_detection(Message& message, const FoundObject& object) {
  const Detection& detection = object.detection;
  message.object = detection.object;
  message.alternatives = detection.alternatives;
  message.view = detection.view;
  message.confidence = static_cast<float>(detection.confidence);
  message.probability = static_cast<float>(detection.probability);
  message.log10_false_alarms = static_cast<float>(detection.log10_false_alarms);
  message.inliers = static_cast<std::uint32_t>(detection.inliers);
  message.features_in_area = static_cast<std::uint32_t>(detection.features_in_area);
  std::copy_n(detection.scene_from_view.val, 9, message.homography.begin());
  for (const cv::Point2f& p : detection.outline) {
    message.outline.emplace_back();
    message.outline.back().x = p.x;
    message.outline.back().y = p.y;
  }
  message.box.x = static_cast<float>(detection.box.x);
  message.box.y = static_cast<float>(detection.box.y);
  message.box.width = static_cast<float>(detection.box.width);
  message.box.height = static_cast<float>(detection.box.height);
  message.track = object.track.id;
  message.confirmed = object.track.confirmed;
  message.frame = object.frame;
  message.has_pose = object.pose.has_value();
  message.pose_ambiguous = object.pose && object.pose->other;
  message.pose_flat = object.pose && object.pose->flat;
  const ObjectPose none;
  const ObjectPose& pose = object.pose ? *object.pose : none;
  fill_pose(message.pose, pose.pose);
  fill_pose(message.other_pose, pose.other ? *pose.other : none.pose);
  message.pose_error_px = static_cast<float>(pose.error_px);
}

/// `Message`: posevote_msgs/DetectionArray.
template <class Message>
void fill_detections(Message& message, const Findings& findings, std::uint64_t dropped) {
  message.image_width = static_cast<std::uint32_t>(findings.result.image_size.width);
  message.image_height = static_cast<std::uint32_t>(findings.result.image_size.height);
  message.time_ms = static_cast<float>(findings.result.time_ms.total);
  message.features = static_cast<std::uint32_t>(findings.result.counts.features);
  message.dropped = static_cast<std::uint32_t>(dropped);
  for (const FoundObject& object : findings.objects) {
    message.detections.emplace_back();
    fill_detection(message.detections.back(), object);
  }
}

/// `Message`: posevote_msgs/DatabaseInfo.
template <class Message>
void fill_database(Message& message, const DatabaseState& state) {
  message.location = state.location;
  message.version = state.version;
  message.features = state.features;
  message.read_only = state.read_only;
  message.active = state.active;
  for (const ObjectSummary& object : state.objects) {
    message.objects.emplace_back();
    auto& summary = message.objects.back();
    summary.object = object.name;
    summary.views = static_cast<std::uint32_t>(object.views);
    summary.features = static_cast<std::uint64_t>(object.features);
    summary.first_taught_at = object.first_taught_at;
    summary.last_taught_at = object.last_taught_at;
    summary.active = state.is_active(object.name);
  }
}

/// visualization_msgs/MarkerArray: first one that deletes those of the picture before, then outline
/// and name of every object.
template <class Markers, class Header>
void fill_markers(Markers& message, const Findings& findings, const Header& header) {
  using Marker = typename std::decay_t<decltype(message.markers)>::value_type;
  const auto add = [&](const std::string& ns, int id, auto type,
                       const std::string& object) -> Marker& {
    message.markers.emplace_back();
    Marker& marker = message.markers.back();
    marker.header = header;
    marker.ns = ns;
    marker.id = id;
    marker.type = type;
    marker.pose.orientation.w = 1;
    const cv::Scalar bgr = object_color(object) / 255;
    marker.color.b = static_cast<float>(bgr[0]);
    marker.color.g = static_cast<float>(bgr[1]);
    marker.color.r = static_cast<float>(bgr[2]);
    marker.color.a = 1;
    return marker;
  };
  add("", 0, Marker::CUBE, "").action = Marker::DELETEALL;
  int id = 0;
  for (const FoundObject& object : findings.objects) {
    if (object.outline.empty()) continue;
    const LabelPlace place = place_label(object.outline);
    const std::string& name = object.detection.object;
    Marker& line = add("outline", ++id, Marker::LINE_STRIP, name);
    line.scale.x = place.line_width_m;
    for (std::size_t i = 0; i <= object.outline.size(); ++i) {
      line.points.emplace_back();
      fill_point(line.points.back(), object.outline[i % object.outline.size()]);
    }
    Marker& label = add("name", id, Marker::TEXT_VIEW_FACING, name);
    label.scale.z = place.letter_height_m;
    fill_point(label.pose.position, place.position);
    label.text = name;
  }
}

/// geometry_msgs/TransformStamped for every confirmed object with a pose, at the end of `message`.
template <class Transforms, class Header>
void fill_transforms(Transforms& message, const Findings& findings, const Header& header) {
  for (const FoundObject& object : findings.objects) {
    if (!object.pose || !object.track.confirmed) continue;
    message.emplace_back();
    auto& transform = message.back();
    transform.header = header;
    transform.child_frame_id = object.frame;
    fill_point(transform.transform.translation, object.pose->pose.translation);
    fill_quaternion(transform.transform.rotation, object.pose->pose.rotation);
  }
}

/// `Goal`: of posevote_msgs/Teach.
template <class Goal>
[[nodiscard]] Lesson to_lesson(const Goal& goal) {
  Lesson lesson;
  lesson.object = goal.object;
  if (!goal.method.empty()) lesson.method = goal.method;
  lesson.box = cv::Rect(cv::Rect2f(goal.box.x, goal.box.y, goal.box.width, goal.box.height));
  if (goal.views > 0) lesson.views = static_cast<int>(std::min<std::uint32_t>(goal.views, 1000000));
  lesson.first_yaw_deg = goal.first_yaw_deg;
  lesson.turn_deg = goal.turn_deg;
  lesson.manual = goal.manual;
  return lesson;
}

/// `Feedback`: of posevote_msgs/Teach.
template <class Feedback, class Header>
void fill_feedback(Feedback& feedback, const TeachProgress& progress, const Header& header) {
  feedback.step = progress.step;
  feedback.instruction = progress.instruction;
  feedback.views_taken = static_cast<std::uint32_t>(progress.views_taken + progress.views_known);
  feedback.views_wanted = static_cast<std::uint32_t>(progress.views_wanted);
  for (const double yaw : progress.yaws_deg) feedback.yaws_deg.push_back(static_cast<float>(yaw));
  feedback.features = static_cast<std::uint32_t>(progress.features);
  feedback.advice = progress.advice;
  if (progress.preview.empty()) return;
  feedback.preview.header = header;
  fill_image(feedback.preview, progress.preview);
}

/// `Result`: of posevote_msgs/Teach.
template <class Result>
void fill_result(Result& result, const TeachProgress& progress) {
  result.success = progress.step == "done" && progress.views_taken + progress.views_known > 0;
  result.views_added = static_cast<std::uint32_t>(progress.views_taken);
  result.views_known = static_cast<std::uint32_t>(progress.views_known);
  result.views_refused = static_cast<std::uint32_t>(progress.views_refused);
  for (const std::string& sentence : progress.advice)
    result.message += (result.message.empty() ? "" : " ") + sentence;
}

}  // namespace posevote::logic
