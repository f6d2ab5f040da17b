// The camera's pictures.
#pragma once

#include <functional>
#include <mutex>
#include <opencv2/core.hpp>
#include <optional>
#include <rclcpp_lifecycle/lifecycle_node.hpp>
#include <sensor_msgs/msg/camera_info.hpp>
#include <sensor_msgs/msg/compressed_image.hpp>
#include <sensor_msgs/msg/image.hpp>
#include <string>

#include "logic/pose.hpp"

namespace posevote::ros2 {

/// A picture as it came; decoded by whoever uses it.
struct Frame {
  std_msgs::msg::Header header;
  sensor_msgs::msg::Image::ConstSharedPtr raw;
  sensor_msgs::msg::CompressedImage::ConstSharedPtr compressed;
  sensor_msgs::msg::CameraInfo::ConstSharedPtr info;  ///< newest of this camera; null: none yet

  /// Throws Error{unreadable_image}.
  [[nodiscard]] cv::Mat picture() const;
  [[nodiscard]] std::optional<logic::Camera> camera() const;
};

/// Subscribed, while it lives, to `image` (or `image/compressed`, which is decoded here) and the
/// camera_info beside it, with the quality of service of sensors and a queue of one.
class CameraInput {
 public:
  CameraInput(rclcpp_lifecycle::LifecycleNode& node, const std::string& transport,
              std::function<void(const Frame&)> receive);

 private:
  void receive(Frame frame);

  std::function<void(const Frame&)> receive_;
  std::mutex info_mutex_;
  sensor_msgs::msg::CameraInfo::ConstSharedPtr info_;
  rclcpp::SubscriptionBase::SharedPtr images_, infos_;
};

/// The topic `image` after remapping.
[[nodiscard]] std::string camera_topic(rclcpp_lifecycle::LifecycleNode& node);

}  // namespace posevote::ros2
