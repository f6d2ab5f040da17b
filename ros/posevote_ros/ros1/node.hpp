// The recognition node for ROS 1, on its own or as a nodelet. Decides nothing: see logic/.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include <atomic>
#include <memory>
#include <mutex>

#include "logic/health.hpp"
#include "logic/latest.hpp"
#include "logic/newest_worker.hpp"
#include "logic/object_recognition.hpp"
#include "ros1/camera_input.hpp"
#include "ros1/parameters.hpp"
#include "ros1/vision.hpp"

namespace posevote::ros1 {

class Services;
class TeachAction;

/// Threads: `receive` in a spinner's, which only hands the newest picture on; recognition in the
/// worker's; services and timers in other spinners'; goals of the action in one of their own. Needs
/// at least two spinners.
class Node {
 public:
  /// Throws Error when the database or a parameter cannot be used.
  Node(ros::NodeHandle nh, ros::NodeHandle private_nh);
  ~Node();

  [[nodiscard]] logic::ObjectRecognition& recognition() { return recognition_; }
  [[nodiscard]] const std::string& camera_topic() const { return camera_->topic(); }

  /// Sends the database's state to `~database` if it has changed.
  void publish_database();

  /// While one of these lives, the camera is subscribed to and `frames()` gets its pictures.
  class Demand {
   public:
    explicit Demand(Node& node) : node_(node) { node_.demand(1); }
    ~Demand() { node_.demand(-1); }
    Demand(const Demand&) = delete;
    Demand& operator=(const Demand&) = delete;

   private:
    Node& node_;
  };
  [[nodiscard]] logic::Latest<Frame>& frames() { return frames_; }

 private:
  void advertise(ros::NodeHandle& private_nh);
  void demand(int change);
  [[nodiscard]] bool is_listened_to() const;
  void update_subscription();
  void receive(const Frame& frame);
  void work(const Frame& frame, std::uint64_t dropped);
  void publish(const Frame& frame, const cv::Mat& picture, const logic::Findings& findings,
               std::uint64_t dropped);
  void report_problem(const std::string& problem);
  void report_recognition(diagnostic_updater::DiagnosticStatusWrapper& status);
  void report_database(diagnostic_updater::DiagnosticStatusWrapper& status);

  logic::ObjectRecognition recognition_;
  std::mutex health_mutex_;
  logic::Health health_;
  std::atomic<int> demands_{0};
  std::mutex subscription_mutex_;
  logic::Latest<Frame> frames_;

  ros::Publisher detections_, markers_, database_;
  std::unique_ptr<VisionPublisher> vision_;
  image_transport::Publisher annotated_;
  tf2_ros::TransformBroadcaster transforms_;
  diagnostic_updater::Updater diagnostics_;
  std::unique_ptr<CameraInput> camera_;
  std::unique_ptr<Reconfiguration> reconfiguration_;
  std::unique_ptr<Services> services_;
  std::unique_ptr<TeachAction> teach_action_;
  ros::WallTimer timer_;
  std::unique_ptr<logic::NewestWorker<Frame>> worker_;
};

}  // namespace posevote::ros1
