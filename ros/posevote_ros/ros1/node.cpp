#include "ros1/node.hpp"

#include <posevote_msgs/DatabaseInfo.h>
#include <posevote_msgs/DetectionArray.h>
#include <visualization_msgs/MarkerArray.h>

#include "logic/fill_message.hpp"
#include "logic/report_status.hpp"
#include "posevote/core/error.hpp"
#include "posevote/render/annotate.hpp"
#include "ros1/convert.hpp"
#include "ros1/services.hpp"
#include "ros1/teach_action.hpp"

namespace posevote::ros1 {

Node::Node(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : recognition_(read_parameters(private_nh)), diagnostics_(nh, private_nh) {
  worker_ = std::make_unique<logic::NewestWorker<Frame>>(
      [this](const Frame& frame, std::uint64_t dropped) { work(frame, dropped); });
  camera_ = std::make_unique<CameraInput>(nh, recognition_.options().transport,
                                          [this](const Frame& frame) { receive(frame); });
  advertise(private_nh);
  reconfiguration_ = std::make_unique<Reconfiguration>(private_nh, recognition_,
                                                       [this] { update_subscription(); });
  services_ = std::make_unique<Services>(private_nh, *this);
  teach_action_ = std::make_unique<TeachAction>(private_nh, *this);
  diagnostics_.setHardwareID("none");
  diagnostics_.add("recognition", this, &Node::report_recognition);
  diagnostics_.add("database", this, &Node::report_database);
  timer_ = nh.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) {
    publish_database();
    diagnostics_.update();
  });
  publish_database();
  update_subscription();
  ROS_INFO("objects in '%s'; pictures from '%s'", recognition_.database().location.c_str(),
           camera_->topic().c_str());
}

/// What may still call back ends first.
Node::~Node() {
  timer_.stop();
  teach_action_.reset();
  services_.reset();
  reconfiguration_.reset();
  camera_.reset();
  worker_.reset();
}

void Node::advertise(ros::NodeHandle& private_nh) {
  // Listeners may come before all of these are made.
  const std::lock_guard<std::mutex> lock(subscription_mutex_);
  const auto connected = [this](const auto&) { update_subscription(); };
  detections_ =
      private_nh.advertise<posevote_msgs::DetectionArray>("detections", 1, connected, connected);
  markers_ =
      private_nh.advertise<visualization_msgs::MarkerArray>("markers", 1, connected, connected);
  annotated_ =
      image_transport::ImageTransport(private_nh).advertise("annotated", 1, connected, connected);
  vision_ = std::make_unique<VisionPublisher>(private_nh, [this] { update_subscription(); });
  database_ = private_nh.advertise<posevote_msgs::DatabaseInfo>("database", 1, true);
}

void Node::demand(int change) {
  demands_ += change;
  update_subscription();
}

bool Node::is_listened_to() const {
  return detections_.getNumSubscribers() > 0 || markers_.getNumSubscribers() > 0 ||
         annotated_.getNumSubscribers() > 0 || (vision_ && vision_->is_listened_to()) ||
         recognition_.options().publish_tf;
}

void Node::update_subscription() {
  const std::lock_guard<std::mutex> lock(subscription_mutex_);
  if (camera_) camera_->set_needed(demands_ > 0 || is_listened_to());
}

void Node::receive(const Frame& frame) {
  if (demands_ > 0) frames_.offer(frame);
  if (is_listened_to()) worker_->offer(frame);
}

void Node::work(const Frame& frame, std::uint64_t dropped) {
  try {
    const cv::Mat picture = frame.picture();
    const logic::Findings findings = recognition_.recognize(picture, frame.camera());
    publish(frame, picture, findings, dropped);
    const std::lock_guard<std::mutex> lock(health_mutex_);
    health_.add(ros::Time::now().toSec(), frame.header.stamp.toSec(), findings.result.time_ms.total,
                dropped);
    if (!findings.problem.empty()) ROS_WARN_THROTTLE(10, "no pose: %s", findings.problem.c_str());
  } catch (const std::exception& error) {
    report_problem(error.what());
  }
}

void Node::publish(const Frame& frame, const cv::Mat& picture, const logic::Findings& findings,
                   std::uint64_t dropped) {
  posevote_msgs::DetectionArray detections;
  detections.header = frame.header;
  logic::fill_detections(detections, findings, dropped);
  detections_.publish(detections);
  vision_->publish(findings, frame.header, recognition_);
  if (markers_.getNumSubscribers() > 0) {
    visualization_msgs::MarkerArray markers;
    logic::fill_markers(markers, findings, frame.header);
    markers_.publish(markers);
  }
  if (annotated_.getNumSubscribers() > 0)
    annotated_.publish(to_message(annotate(picture, findings.result), frame.header));
  if (recognition_.options().publish_tf) {
    std::vector<geometry_msgs::TransformStamped> transforms;
    logic::fill_transforms(transforms, findings, frame.header);
    if (!transforms.empty()) transforms_.sendTransform(transforms);
  }
}

void Node::publish_database() {
  if (!recognition_.changed()) return;
  posevote_msgs::DatabaseInfo info;
  info.header.stamp = ros::Time::now();
  logic::fill_database(info, recognition_.database());
  database_.publish(info);
}

void Node::report_problem(const std::string& problem) {
  ROS_WARN_THROTTLE(10, "%s", problem.c_str());
  const std::lock_guard<std::mutex> lock(health_mutex_);
  health_.add_problem(problem);
}

void Node::report_recognition(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(health_mutex_);
  const logic::HealthReport report = health_.report(ros::Time::now().toSec());
  logic::report_health(status, report, recognition_.options().slow_ms, is_listened_to());
}

void Node::report_database(diagnostic_updater::DiagnosticStatusWrapper& status) {
  logic::report_database(status, recognition_.database());
}

}  // namespace posevote::ros1
