#include "ros1/camera_input.hpp"

#include <image_transport/camera_common.h>

#include "ros1/convert.hpp"

namespace posevote::ros1 {

cv::Mat Frame::picture() const {
  return raw ? to_picture(*raw) : to_picture(*compressed);
}

std::optional<logic::Camera> Frame::camera() const {
  if (!info) return std::nullopt;
  return to_camera(*info);
}

CameraInput::CameraInput(ros::NodeHandle nh, const std::string& transport,
                         std::function<void(const Frame&)> receive)
    : nh_(nh),
      transport_(nh),
      compressed_(transport == "compressed"),
      topic_(nh.resolveName("image")),
      receive_(std::move(receive)) {}

void CameraInput::set_needed(bool needed) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (needed == subscribed_) return;
  subscribed_ = needed;
  if (needed) {
    subscribe();
    return;
  }
  images_.shutdown();
  compressed_images_.shutdown();
  infos_.shutdown();
}

void CameraInput::subscribe() {
  infos_ =
      nh_.subscribe<sensor_msgs::CameraInfo>(image_transport::getCameraInfoTopic(topic_), 1,
                                             [this](const sensor_msgs::CameraInfoConstPtr& info) {
                                               const std::lock_guard<std::mutex> lock(info_mutex_);
                                               info_ = info;
                                             });
  if (compressed_)
    compressed_images_ = nh_.subscribe<sensor_msgs::CompressedImage>(
        topic_ + "/compressed", 1, [this](const sensor_msgs::CompressedImageConstPtr& image) {
          receive({image->header, nullptr, image, nullptr});
        });
  else
    images_ = transport_.subscribe(
        topic_, 1,
        [this](const sensor_msgs::ImageConstPtr& image) {
          receive({image->header, image, nullptr, nullptr});
        },
        {}, image_transport::TransportHints("raw", ros::TransportHints().tcpNoDelay()));
}

void CameraInput::receive(Frame frame) {
  {
    const std::lock_guard<std::mutex> lock(info_mutex_);
    frame.info = info_;
  }
  receive_(frame);
}

}  // namespace posevote::ros1
