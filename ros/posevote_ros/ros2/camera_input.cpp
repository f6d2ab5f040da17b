#include "ros2/camera_input.hpp"

#include "ros2/convert.hpp"

namespace posevote::ros2 {

cv::Mat Frame::picture() const {
  return raw ? to_picture(*raw) : to_picture(*compressed);
}

std::optional<logic::Camera> Frame::camera() const {
  if (!info) return std::nullopt;
  return to_camera(*info);
}

std::string camera_topic(rclcpp_lifecycle::LifecycleNode& node) {
  return node.get_node_topics_interface()->resolve_topic_name("image");
}

CameraInput::CameraInput(rclcpp_lifecycle::LifecycleNode& node, const std::string& transport,
                         std::function<void(const Frame&)> receive)
    : receive_(std::move(receive)) {
  const rclcpp::QoS newest = rclcpp::SensorDataQoS().keep_last(1);
  const std::string topic = camera_topic(node);
  infos_ = node.create_subscription<sensor_msgs::msg::CameraInfo>(
      topic.substr(0, topic.rfind('/')) + "/camera_info", newest,
      [this](sensor_msgs::msg::CameraInfo::ConstSharedPtr info) {
        const std::lock_guard lock(info_mutex_);
        info_ = info;
      });
  if (transport == "compressed")
    images_ = node.create_subscription<sensor_msgs::msg::CompressedImage>(
        topic + "/compressed", newest,
        [this](sensor_msgs::msg::CompressedImage::ConstSharedPtr image) {
          this->receive({image->header, nullptr, image, nullptr});
        });
  else
    images_ = node.create_subscription<sensor_msgs::msg::Image>(
        topic, newest, [this](sensor_msgs::msg::Image::ConstSharedPtr image) {
          this->receive({image->header, image, nullptr, nullptr});
        });
}

void CameraInput::receive(Frame frame) {
  {
    const std::lock_guard lock(info_mutex_);
    frame.info = info_;
  }
  receive_(frame);
}

}  // namespace posevote::ros2
