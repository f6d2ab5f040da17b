// The node's services; see logic/serve.hpp. What cannot be done is a response with success = false
// and the reason.
#pragma once

#include <ros/ros.h>

#include <vector>

namespace posevote::ros1 {

class Node;

class Services {
 public:
  Services(ros::NodeHandle private_nh, Node& node);

 private:
  /// Advertises `name`; `act` fills the response, and what it throws does.
  template <class Service, class Act>
  void add(ros::NodeHandle& nh, const std::string& name, Act act);

  Node& node_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace posevote::ros1
