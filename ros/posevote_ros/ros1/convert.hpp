// What of the messages is different in ROS 1; see logic/fill_message.hpp for the rest.
#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <opencv2/core.hpp>

#include "logic/pose.hpp"

namespace posevote::ros1 {

/// Throws Error{unreadable_image}: see `logic::to_picture` and `decode_image`.
[[nodiscard]] cv::Mat to_picture(const sensor_msgs::Image& message);
[[nodiscard]] cv::Mat to_picture(const sensor_msgs::CompressedImage& message);
[[nodiscard]] sensor_msgs::Image to_message(const cv::Mat& picture, const std_msgs::Header& header);
[[nodiscard]] logic::Camera to_camera(const sensor_msgs::CameraInfo& message);

}  // namespace posevote::ros1
