// The node's services; see logic/serve.hpp.
#pragma once

#include <atomic>
#include <future>
#include <list>
#include <mutex>
#include <posevote_msgs/srv/detect.hpp>
#include <rclcpp/service.hpp>
#include <string>
#include <vector>

namespace posevote::ros2 {

class Node;

class Services {
 public:
  explicit Services(Node& node);
  /// Gives up waiting for pictures.
  ~Services();

 private:
  using Detect = posevote_msgs::srv::Detect;

  template <class Service, class Act>
  void offer(const std::string& name, Act act);
  void offer_detect();
  void detect(const Detect::Request& request, Detect::Response& response);

  Node& node_;
  std::atomic<bool> stopped_{false};
  std::list<std::future<void>> waiting_;  ///< calls of `detect` that are not answered yet
  std::vector<rclcpp::ServiceBase::SharedPtr> servers_;
};

}  // namespace posevote::ros2
