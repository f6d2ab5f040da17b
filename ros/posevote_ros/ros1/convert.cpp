#include "ros1/convert.hpp"

#include "logic/fill_message.hpp"
#include "posevote/image/read_image.hpp"

namespace posevote::ros1 {

cv::Mat to_picture(const sensor_msgs::Image& message) {
  return logic::to_picture(logic::view_of(message));
}

cv::Mat to_picture(const sensor_msgs::CompressedImage& message) {
  return decode_image(message.data, "compressed image message");
}

sensor_msgs::Image to_message(const cv::Mat& picture, const std_msgs::Header& header) {
  sensor_msgs::Image message;
  message.header = header;
  logic::fill_image(message, picture);
  return message;
}

logic::Camera to_camera(const sensor_msgs::CameraInfo& message) {
  logic::Camera camera;
  camera.size = {static_cast<int>(message.width), static_cast<int>(message.height)};
  camera.matrix = cv::Matx33d(message.K.data());
  const auto& p = message.P;
  camera.rectified_matrix = {p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]};
  camera.distortion_model = message.distortion_model;
  camera.distortion.assign(message.D.begin(), message.D.end());
  const auto& roi = message.roi;
  if (roi.width == 0 || roi.height == 0) return camera;
  return logic::crop_camera(camera, {static_cast<int>(roi.x_offset), static_cast<int>(roi.y_offset),
                                     static_cast<int>(roi.width), static_cast<int>(roi.height)});
}

}  // namespace posevote::ros1
