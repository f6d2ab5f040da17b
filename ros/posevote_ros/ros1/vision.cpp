#include "ros1/vision.hpp"

#ifdef POSEVOTE_WITH_VISION_MSGS
#include <vision_msgs/Detection2DArray.h>
#include <vision_msgs/Detection3DArray.h>

#include "logic/fill_message.hpp"
#endif

namespace posevote::ros1 {

#ifdef POSEVOTE_WITH_VISION_MSGS

namespace {

vision_msgs::ObjectHypothesisWithPose to_hypothesis(const logic::FoundObject& object,
                                                    const logic::DatabaseState& database) {
  vision_msgs::ObjectHypothesisWithPose hypothesis;
  hypothesis.id = database.place_of(object.detection.object);
  hypothesis.score = object.detection.probability;
  const logic::Pose none;
  logic::fill_pose(hypothesis.pose.pose, object.pose ? object.pose->pose : none);
  return hypothesis;
}

vision_msgs::Detection2D to_flat(const logic::FoundObject& object, const std_msgs::Header& header,
                                 const logic::DatabaseState& database) {
  const cv::Rect2d& box = object.detection.box;
  vision_msgs::Detection2D detection;
  detection.header = header;
  detection.results.push_back(to_hypothesis(object, database));
  detection.bbox.center.x = box.x + box.width / 2;
  detection.bbox.center.y = box.y + box.height / 2;
  detection.bbox.size_x = box.width;
  detection.bbox.size_y = box.height;
  return detection;
}

vision_msgs::Detection3D to_solid(const logic::FoundObject& object, const std_msgs::Header& header,
                                  const logic::DatabaseState& database) {
  vision_msgs::Detection3D detection;
  detection.header = header;
  detection.results.push_back(to_hypothesis(object, database));
  logic::fill_pose(detection.bbox.center, object.pose->view_pose);
  detection.bbox.size.x = object.pose->size_m.width;
  detection.bbox.size.y = object.pose->size_m.height;
  return detection;
}

}  // namespace

VisionPublisher::VisionPublisher(ros::NodeHandle private_nh,
                                 const std::function<void()>& connected) {
  const auto changed = [connected](const ros::SingleSubscriberPublisher&) { connected(); };
  flat_ = private_nh.advertise<vision_msgs::Detection2DArray>("detections_2d", 1, changed, changed);
  solid_ =
      private_nh.advertise<vision_msgs::Detection3DArray>("detections_3d", 1, changed, changed);
}

bool VisionPublisher::is_listened_to() const {
  return flat_.getNumSubscribers() > 0 || solid_.getNumSubscribers() > 0;
}

void VisionPublisher::publish(const logic::Findings& findings, const std_msgs::Header& header,
                              const logic::ObjectRecognition& recognition) const {
  if (!is_listened_to()) return;
  const logic::DatabaseState database = recognition.database();
  vision_msgs::Detection2DArray flat;
  vision_msgs::Detection3DArray solid;
  flat.header = solid.header = header;
  for (const logic::FoundObject& object : findings.objects) {
    flat.detections.push_back(to_flat(object, header, database));
    if (object.pose) solid.detections.push_back(to_solid(object, header, database));
  }
  flat_.publish(flat);
  solid_.publish(solid);
}

#else

VisionPublisher::VisionPublisher(ros::NodeHandle, const std::function<void()>&) {}

bool VisionPublisher::is_listened_to() const {
  return false;
}

void VisionPublisher::publish(const logic::Findings&, const std_msgs::Header&,
                              const logic::ObjectRecognition&) const {}

#endif

}  // namespace posevote::ros1
