// The recognition node for ROS 2, a component with a life cycle. Decides nothing: see logic/.
#pragma once

#include <tf2_ros/transform_broadcaster.h>
#include <diagnostic_updater/diagnostic_updater.hpp>
#include <memory>
#include <mutex>
#include <posevote_msgs/msg/database_info.hpp>
#include <posevote_msgs/msg/detection_array.hpp>
#include <rclcpp_lifecycle/lifecycle_node.hpp>
#include <rclcpp_lifecycle/lifecycle_publisher.hpp>
#include <sensor_msgs/msg/image.hpp>
#include <string>
#include <vision_msgs/msg/detection2_d_array.hpp>
#include <vision_msgs/msg/detection3_d_array.hpp>
#include <visualization_msgs/msg/marker_array.hpp>

#include "logic/health.hpp"
#include "logic/latest.hpp"
#include "logic/newest_worker.hpp"
#include "logic/object_recognition.hpp"
#include "ros2/camera_input.hpp"
#include "ros2/parameters.hpp"

namespace posevote::ros2 {

class Services;
class TeachAction;

/// configure: opens the database, offers services and the Teach action; activate: subscribes to the
/// camera and publishes. Callbacks return at once, so that any executor will do: recognition has a
/// worker thread, teaching and waiting for a picture have threads of their own.
class Node : public rclcpp_lifecycle::LifecycleNode {
 public:
  using CallbackReturn = rclcpp_lifecycle::node_interfaces::LifecycleNodeInterface::CallbackReturn;

  explicit Node(const rclcpp::NodeOptions& options);
  ~Node() override;

  CallbackReturn on_configure(const rclcpp_lifecycle::State& state) override;
  CallbackReturn on_activate(const rclcpp_lifecycle::State& state) override;
  CallbackReturn on_deactivate(const rclcpp_lifecycle::State& state) override;
  CallbackReturn on_cleanup(const rclcpp_lifecycle::State& state) override;
  CallbackReturn on_shutdown(const rclcpp_lifecycle::State& state) override;

  /// Only while configured.
  [[nodiscard]] logic::ObjectRecognition& recognition() { return *recognition_; }
  [[nodiscard]] logic::Latest<Frame>& frames() { return frames_; }

  /// Sends the database's state to `~/database` if it has changed.
  void publish_database();

 private:
  template <class Message>
  using Publisher = std::shared_ptr<rclcpp_lifecycle::LifecyclePublisher<Message>>;

  void advertise();
  void release();
  [[nodiscard]] bool is_listened_to() const;
  void receive(const Frame& frame);
  void work(const Frame& frame, std::uint64_t dropped);
  void publish(const Frame& frame, const cv::Mat& picture, const logic::Findings& findings,
               std::uint64_t dropped);
  void report_problem(const std::string& problem);
  void report_recognition(diagnostic_updater::DiagnosticStatusWrapper& status);
  void report_database(diagnostic_updater::DiagnosticStatusWrapper& status);

  Parameters parameters_;
  diagnostic_updater::Updater diagnostics_;
  std::mutex health_mutex_;
  logic::Health health_;
  logic::Latest<Frame> frames_;

  std::unique_ptr<logic::ObjectRecognition> recognition_;
  Publisher<posevote_msgs::msg::DetectionArray> detections_;
  Publisher<vision_msgs::msg::Detection2DArray> detections_2d_;
  Publisher<vision_msgs::msg::Detection3DArray> detections_3d_;
  Publisher<visualization_msgs::msg::MarkerArray> markers_;
  Publisher<sensor_msgs::msg::Image> annotated_;
  Publisher<posevote_msgs::msg::DatabaseInfo> database_;
  std::unique_ptr<tf2_ros::TransformBroadcaster> transforms_;
  std::unique_ptr<Services> services_;
  std::unique_ptr<TeachAction> teach_action_;
  rclcpp::TimerBase::SharedPtr timer_;
  std::unique_ptr<logic::NewestWorker<Frame>> worker_;
  std::unique_ptr<CameraInput> camera_;
};

}  // namespace posevote::ros2
