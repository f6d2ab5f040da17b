#include "ros2/convert.hpp"

#include "logic/fill_message.hpp"
#include "posevote/image/read_image.hpp"

namespace posevote::ros2 {
namespace {

vision_msgs::msg::ObjectHypothesisWithPose to_hypothesis(const logic::FoundObject& object) {
  vision_msgs::msg::ObjectHypothesisWithPose hypothesis;
  hypothesis.hypothesis.class_id = object.detection.object;
  hypothesis.hypothesis.score = object.detection.probability;
  if (object.pose) logic::fill_pose(hypothesis.pose.pose, object.pose->pose);
  return hypothesis;
}

std::string id_of(const logic::FoundObject& object) {
  return object.track.id == 0 ? "" : std::to_string(object.track.id);
}

}  // namespace

cv::Mat to_picture(const sensor_msgs::msg::Image& message) {
  return logic::to_picture(logic::view_of(message));
}

cv::Mat to_picture(const sensor_msgs::msg::CompressedImage& message) {
  return decode_image(message.data, "compressed image message");
}

logic::Camera to_camera(const sensor_msgs::msg::CameraInfo& message) {
  logic::Camera camera;
  camera.size = {static_cast<int>(message.width), static_cast<int>(message.height)};
  camera.matrix = cv::Matx33d(message.k.data());
  const auto& p = message.p;
  camera.rectified_matrix = {p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]};
  camera.distortion_model = message.distortion_model;
  camera.distortion = message.d;
  const auto& roi = message.roi;
  if (roi.width == 0 || roi.height == 0) return camera;
  return logic::crop_camera(camera, {static_cast<int>(roi.x_offset), static_cast<int>(roi.y_offset),
                                     static_cast<int>(roi.width), static_cast<int>(roi.height)});
}

vision_msgs::msg::Detection2DArray to_detections_2d(const logic::Findings& findings,
                                                    const std_msgs::msg::Header& header) {
  vision_msgs::msg::Detection2DArray message;
  message.header = header;
  for (const logic::FoundObject& object : findings.objects) {
    const cv::Rect2d& box = object.detection.box;
    vision_msgs::msg::Detection2D detection;
    detection.header = header;
    detection.id = id_of(object);
    detection.results.push_back(to_hypothesis(object));
    detection.bbox.center.position.x = box.x + box.width / 2;
    detection.bbox.center.position.y = box.y + box.height / 2;
    detection.bbox.size_x = box.width;
    detection.bbox.size_y = box.height;
    message.detections.push_back(detection);
  }
  return message;
}

vision_msgs::msg::Detection3DArray to_detections_3d(const logic::Findings& findings,
                                                    const std_msgs::msg::Header& header) {
  vision_msgs::msg::Detection3DArray message;
  message.header = header;
  for (const logic::FoundObject& object : findings.objects) {
    if (!object.pose) continue;
    vision_msgs::msg::Detection3D detection;
    detection.header = header;
    detection.id = id_of(object);
    detection.results.push_back(to_hypothesis(object));
    logic::fill_pose(detection.bbox.center, object.pose->view_pose);
    detection.bbox.size.x = object.pose->size_m.width;
    detection.bbox.size.y = object.pose->size_m.height;
    message.detections.push_back(detection);
  }
  return message;
}

}  // namespace posevote::ros2
