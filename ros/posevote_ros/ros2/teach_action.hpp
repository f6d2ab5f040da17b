// The Teach action: pictures go to a logic::TeachSession, its progress comes back as feedback.
#pragma once

#include <atomic>
#include <memory>
#include <posevote_msgs/action/teach.hpp>
#include <posevote_msgs/srv/capture.hpp>
#include <rclcpp_action/rclcpp_action.hpp>
#include <string>
#include <thread>

#include "logic/teach_session.hpp"

namespace posevote::ros2 {

class Node;

/// One goal at a time, in a thread of its own; others are refused.
class TeachAction {
 public:
  explicit TeachAction(Node& node);
  ~TeachAction();

 private:
  using Teach = posevote_msgs::action::Teach;
  using Capture = posevote_msgs::srv::Capture;
  using Goal = rclcpp_action::ServerGoalHandle<Teach>;

  void offer_capture();
  void start(const std::shared_ptr<Goal>& goal);
  void execute(const std::shared_ptr<Goal>& goal);
  [[nodiscard]] logic::TeachProgress teach_given(Goal& goal);
  [[nodiscard]] logic::TeachProgress teach_from_camera(Goal& goal);
  [[nodiscard]] logic::TeachView teach_view(const std::string& object, const std::string& source);
  static void report(Goal& goal, const logic::TeachProgress& progress,
                     const std_msgs::msg::Header& header);
  [[nodiscard]] bool is_cancelled(const Goal& goal) const;

  Node& node_;
  std::atomic<bool> busy_{false}, stopped_{false}, capture_{false};
  std::thread thread_;
  rclcpp::Service<Capture>::SharedPtr capture_service_;
  rclcpp_action::Server<Teach>::SharedPtr server_;
};

}  // namespace posevote::ros2
