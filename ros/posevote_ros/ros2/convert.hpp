// What of the messages is different in ROS 2; see logic/fill_message.hpp for the rest.
#pragma once

#include <opencv2/core.hpp>
#include <sensor_msgs/msg/camera_info.hpp>
#include <sensor_msgs/msg/compressed_image.hpp>
#include <sensor_msgs/msg/image.hpp>
#include <vision_msgs/msg/detection2_d_array.hpp>
#include <vision_msgs/msg/detection3_d_array.hpp>

#include "logic/object_recognition.hpp"

namespace posevote::ros2 {

/// Throws Error{unreadable_image}: see `logic::to_picture` and `decode_image`.
[[nodiscard]] cv::Mat to_picture(const sensor_msgs::msg::Image& message);
[[nodiscard]] cv::Mat to_picture(const sensor_msgs::msg::CompressedImage& message);
[[nodiscard]] logic::Camera to_camera(const sensor_msgs::msg::CameraInfo& message);

/// Boxes in the picture: class_id is the object's name, score the probability, id the track.
[[nodiscard]] vision_msgs::msg::Detection2DArray to_detections_2d(
    const logic::Findings& findings, const std_msgs::msg::Header& header);

/// Objects with a pose: flat boxes in the plane of the view.
[[nodiscard]] vision_msgs::msg::Detection3DArray to_detections_3d(
    const logic::Findings& findings, const std_msgs::msg::Header& header);

}  // namespace posevote::ros2
