#include "ros2/node.hpp"

#include <geometry_msgs/msg/transform_stamped.hpp>
#include <rclcpp_components/register_node_macro.hpp>

#include "logic/fill_message.hpp"
#include "logic/report_status.hpp"
#include "posevote/core/error.hpp"
#include "posevote/render/annotate.hpp"
#include "ros2/convert.hpp"
#include "ros2/services.hpp"
#include "ros2/teach_action.hpp"

namespace posevote::ros2 {

using Status = diagnostic_msgs::msg::DiagnosticStatus;

Node::Node(const rclcpp::NodeOptions& options)
    : LifecycleNode("posevote", options), parameters_(*this), diagnostics_(this) {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("recognition", this, &Node::report_recognition);
  diagnostics_.add("database", this, &Node::report_database);
}

Node::~Node() {
  release();
}

Node::CallbackReturn Node::on_configure(const rclcpp_lifecycle::State&) {
  try {
    recognition_ = std::make_unique<logic::ObjectRecognition>(parameters_.given());
  } catch (const std::exception& error) {
    RCLCPP_ERROR(get_logger(), "%s", error.what());
    return CallbackReturn::FAILURE;
  }
  parameters_.follow(recognition_.get());
  worker_ = std::make_unique<logic::NewestWorker<Frame>>(
      [this](const Frame& frame, std::uint64_t dropped) { work(frame, dropped); });
  advertise();
  services_ = std::make_unique<Services>(*this);
  teach_action_ = std::make_unique<TeachAction>(*this);
  timer_ = create_wall_timer(std::chrono::seconds(1), [this] { publish_database(); });
  RCLCPP_INFO(get_logger(), "objects in '%s'; pictures from '%s'",
              recognition_->database().location.c_str(), camera_topic(*this).c_str());
  return CallbackReturn::SUCCESS;
}

void Node::advertise() {
  detections_ = create_publisher<posevote_msgs::msg::DetectionArray>("~/detections", 1);
  detections_2d_ = create_publisher<vision_msgs::msg::Detection2DArray>("~/detections_2d", 1);
  detections_3d_ = create_publisher<vision_msgs::msg::Detection3DArray>("~/detections_3d", 1);
  markers_ = create_publisher<visualization_msgs::msg::MarkerArray>("~/markers", 1);
  annotated_ = create_publisher<sensor_msgs::msg::Image>("~/annotated", 1);
  // Within the process alone, what is latched would not reach later subscribers of other processes.
  rclcpp::PublisherOptions to_all;
  to_all.use_intra_process_comm = rclcpp::IntraProcessSetting::Disable;
  database_ = create_publisher<posevote_msgs::msg::DatabaseInfo>(
      "~/database", rclcpp::QoS(1).transient_local(), to_all);
  transforms_ = std::make_unique<tf2_ros::TransformBroadcaster>(*this);
}

Node::CallbackReturn Node::on_activate(const rclcpp_lifecycle::State& state) {
  try {
    (void)recognition_->changed();
    posevote_msgs::msg::DatabaseInfo info;
    info.header.stamp = now();
    logic::fill_database(info, recognition_->database());
    LifecycleNode::on_activate(state);
    database_->publish(info);
  } catch (const std::exception& error) {
    RCLCPP_ERROR(get_logger(), "%s", error.what());
    return CallbackReturn::FAILURE;
  }
  camera_ = std::make_unique<CameraInput>(*this, recognition_->options().transport,
                                          [this](const Frame& frame) { receive(frame); });
  return CallbackReturn::SUCCESS;
}

Node::CallbackReturn Node::on_deactivate(const rclcpp_lifecycle::State& state) {
  camera_.reset();
  worker_->wait_until_idle();
  LifecycleNode::on_deactivate(state);
  return CallbackReturn::SUCCESS;
}

Node::CallbackReturn Node::on_cleanup(const rclcpp_lifecycle::State&) {
  release();
  return CallbackReturn::SUCCESS;
}

Node::CallbackReturn Node::on_shutdown(const rclcpp_lifecycle::State&) {
  release();
  return CallbackReturn::SUCCESS;
}

/// What may still call back ends first.
void Node::release() {
  camera_.reset();
  timer_.reset();
  teach_action_.reset();
  services_.reset();
  worker_.reset();
  parameters_.follow(nullptr);
  transforms_.reset();
  detections_.reset();
  detections_2d_.reset();
  detections_3d_.reset();
  markers_.reset();
  annotated_.reset();
  database_.reset();
  recognition_.reset();
}

bool Node::is_listened_to() const {
  return detections_->get_subscription_count() > 0 ||
         detections_2d_->get_subscription_count() > 0 ||
         detections_3d_->get_subscription_count() > 0 || markers_->get_subscription_count() > 0 ||
         annotated_->get_subscription_count() > 0 || recognition_->options().publish_tf;
}

void Node::receive(const Frame& frame) {
  frames_.offer(frame);
  if (is_listened_to()) worker_->offer(frame);
}

void Node::work(const Frame& frame, std::uint64_t dropped) {
  try {
    const cv::Mat picture = frame.picture();
    const logic::Findings findings = recognition_->recognize(picture, frame.camera());
    publish(frame, picture, findings, dropped);
    if (!findings.problem.empty())
      RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), 10000, "no pose: %s",
                           findings.problem.c_str());
    const std::lock_guard lock(health_mutex_);
    health_.add(now().seconds(), rclcpp::Time(frame.header.stamp).seconds(),
                findings.result.time_ms.total, dropped);
  } catch (const std::exception& error) {
    report_problem(error.what());
  }
}

void Node::publish(const Frame& frame, const cv::Mat& picture, const logic::Findings& findings,
                   std::uint64_t dropped) {
  posevote_msgs::msg::DetectionArray detections;
  detections.header = frame.header;
  logic::fill_detections(detections, findings, dropped);
  detections_->publish(detections);
  if (detections_2d_->get_subscription_count() > 0)
    detections_2d_->publish(to_detections_2d(findings, frame.header));
  if (detections_3d_->get_subscription_count() > 0)
    detections_3d_->publish(to_detections_3d(findings, frame.header));
  if (markers_->get_subscription_count() > 0) {
    visualization_msgs::msg::MarkerArray markers;
    logic::fill_markers(markers, findings, frame.header);
    markers_->publish(markers);
  }
  if (annotated_->get_subscription_count() > 0) {
    sensor_msgs::msg::Image drawn;
    drawn.header = frame.header;
    logic::fill_image(drawn, annotate(picture, findings.result));
    annotated_->publish(drawn);
  }
  if (recognition_->options().publish_tf) {
    std::vector<geometry_msgs::msg::TransformStamped> transforms;
    logic::fill_transforms(transforms, findings, frame.header);
    if (!transforms.empty()) transforms_->sendTransform(transforms);
  }
}

void Node::publish_database() {
  if (!database_->is_activated() || !recognition_->changed()) return;
  posevote_msgs::msg::DatabaseInfo info;
  info.header.stamp = now();
  logic::fill_database(info, recognition_->database());
  database_->publish(info);
}

void Node::report_problem(const std::string& problem) {
  RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), 10000, "%s", problem.c_str());
  const std::lock_guard lock(health_mutex_);
  health_.add_problem(problem);
}

void Node::report_recognition(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!camera_) {
    status.summary(Status::OK, "not active");
    return;
  }
  const std::lock_guard lock(health_mutex_);
  const logic::HealthReport report = health_.report(now().seconds());
  logic::report_health(status, report, recognition_->options().slow_ms, is_listened_to());
}

void Node::report_database(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!recognition_) {
    status.summary(Status::OK, "not configured");
    return;
  }
  logic::report_database(status, recognition_->database());
}

}  // namespace posevote::ros2

RCLCPP_COMPONENTS_REGISTER_NODE(posevote::ros2::Node)
