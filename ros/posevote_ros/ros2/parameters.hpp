// The node's options as declared parameters. Names, defaults, ranges and descriptions come from the
// options themselves.
#pragma once

#include <rclcpp_lifecycle/lifecycle_node.hpp>
#include <set>
#include <string>
#include <vector>

#include "logic/node_options.hpp"
#include "logic/object_recognition.hpp"

namespace posevote::ros2 {

class Parameters {
 public:
  /// Declares every option; values given on the command line or in a file count.
  explicit Parameters(rclcpp_lifecycle::LifecycleNode& node);

  /// Options whose value was given, when the node started or since.
  [[nodiscard]] logic::Settings given() const;

  /// From now on what is set goes to `recognition`, and is refused with its reason; null: it is
  /// only kept. The parameters take the values that are in force.
  void follow(logic::ObjectRecognition* recognition);

 private:
  void declare(const OptionField& field);
  void show(logic::NodeOptions options);
  rcl_interfaces::msg::SetParametersResult set(const std::vector<rclcpp::Parameter>& parameters);

  rclcpp_lifecycle::LifecycleNode& node_;
  std::set<std::string> names_, given_;
  logic::ObjectRecognition* recognition_ = nullptr;
  bool showing_ = false;
  rclcpp::node_interfaces::OnSetParametersCallbackHandle::SharedPtr handle_;
};

}  // namespace posevote::ros2
