// The Teach action: pictures go to a logic::TeachSession, its progress comes back as feedback.
#pragma once

#include <actionlib/server/simple_action_server.h>
#include <posevote_msgs/Capture.h>
#include <posevote_msgs/TeachAction.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <atomic>

#include "logic/teach_session.hpp"
#include "ros1/camera_input.hpp"

namespace posevote::ros1 {

class Node;

class TeachAction {
 public:
  TeachAction(ros::NodeHandle private_nh, Node& node);
  ~TeachAction();

 private:
  void execute(const posevote_msgs::TeachGoalConstPtr& goal);
  [[nodiscard]] logic::TeachProgress teach_given(const posevote_msgs::TeachGoal& goal);
  [[nodiscard]] logic::TeachProgress teach_from_camera(const posevote_msgs::TeachGoal& goal);
  [[nodiscard]] logic::TeachView teach_view(const std::string& object, const std::string& source);
  void report(const logic::TeachProgress& progress, const std_msgs::Header& header);
  [[nodiscard]] bool is_cancelled() {
    return server_.isPreemptRequested() || stopped_ || !ros::ok();
  }

  Node& node_;
  std::atomic<bool> capture_{false}, stopped_{false};
  ros::ServiceServer capture_service_;
  // A goal and what cancels it come one after the other: a SimpleActionServer forgets a cancel that
  // another thread handles while the goal is being put down.
  ros::CallbackQueue queue_;
  actionlib::SimpleActionServer<posevote_msgs::TeachAction> server_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace posevote::ros1
