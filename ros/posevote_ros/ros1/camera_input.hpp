// The camera's pictures: subscribed to only while somebody needs them.
#pragma once

#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <functional>
#include <mutex>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "logic/pose.hpp"

namespace posevote::ros1 {

/// A picture as it came; decoded by whoever uses it.
struct Frame {
  std_msgs::Header header;
  sensor_msgs::ImageConstPtr raw;
  sensor_msgs::CompressedImageConstPtr compressed;
  sensor_msgs::CameraInfoConstPtr info;  ///< the newest of this camera; null: none yet

  /// Throws Error{unreadable_image}.
  [[nodiscard]] cv::Mat picture() const;
  [[nodiscard]] std::optional<logic::Camera> camera() const;
};

/// Subscribes to `image` (or `image/compressed`, which is decoded here: no plugin is needed) and
/// the camera_info beside it. Queues hold one message: what is not fetched in time is old.
class CameraInput {
 public:
  CameraInput(ros::NodeHandle nh, const std::string& transport,
              std::function<void(const Frame&)> receive);

  /// Subscribes or unsubscribes.
  void set_needed(bool needed);
  [[nodiscard]] const std::string& topic() const { return topic_; }

 private:
  void subscribe();
  void receive(Frame frame);

  ros::NodeHandle nh_;
  image_transport::ImageTransport transport_;
  const bool compressed_;
  const std::string topic_;
  std::function<void(const Frame&)> receive_;
  std::mutex mutex_;
  bool subscribed_ = false;
  image_transport::Subscriber images_;
  ros::Subscriber compressed_images_, infos_;
  std::mutex info_mutex_;
  sensor_msgs::CameraInfoConstPtr info_;
};

}  // namespace posevote::ros1
