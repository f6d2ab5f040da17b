// Detections as vision_msgs, where that package was found when this was built.
#pragma once

#include <ros/ros.h>
#include <std_msgs/Header.h>

#include <functional>

#include "logic/object_recognition.hpp"

namespace posevote::ros1 {

/// `~detections_2d` and `~detections_3d` (vision_msgs/Detection2DArray, Detection3DArray; the
/// latter for objects with a pose: flat boxes in the plane of the view). In ROS 1 these hold no
/// names but numbers: the place of the object in the list that `~database` sends, from 0. Without
/// vision_msgs nothing is offered, and nobody listens.
class VisionPublisher {
 public:
  /// `connected` is called when listeners come and go.
  VisionPublisher(ros::NodeHandle private_nh, const std::function<void()>& connected);

  [[nodiscard]] bool is_listened_to() const;
  void publish(const logic::Findings& findings, const std_msgs::Header& header,
               const logic::ObjectRecognition& recognition) const;

 private:
  ros::Publisher flat_, solid_;
};

}  // namespace posevote::ros1
