// The node's options on the parameter server and in dynamic_reconfigure. Names, defaults, ranges
// and descriptions come from the options themselves.
#pragma once

#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/ros.h>

#include "logic/node_options.hpp"
#include "logic/object_recognition.hpp"

namespace posevote::ros1 {

/// Private parameters that are options, e.g. ~vote/smooth, ~database. `object_heights` may be a
/// dictionary. Throws Error{invalid_argument} for a parameter whose type no option has.
[[nodiscard]] logic::Settings read_parameters(const ros::NodeHandle& private_nh);

/// What rqt_reconfigure shows.
[[nodiscard]] dynamic_reconfigure::ConfigDescription describe(logic::NodeOptions options);
[[nodiscard]] dynamic_reconfigure::Config to_config(logic::NodeOptions options);
/// The entries of `config` that differ from `options`.
[[nodiscard]] logic::Settings changes(const dynamic_reconfigure::Config& config,
                                      logic::NodeOptions options);

/// The dynamic_reconfigure server of a node: ~set_parameters, ~parameter_descriptions,
/// ~parameter_updates. What cannot be set is logged, and the answer says what is in force.
class Reconfiguration {
 public:
  Reconfiguration(ros::NodeHandle private_nh, logic::ObjectRecognition& recognition,
                  std::function<void()> changed);

 private:
  bool set(dynamic_reconfigure::Reconfigure::Request& request,
           dynamic_reconfigure::Reconfigure::Response& response);

  logic::ObjectRecognition& recognition_;
  std::function<void()> changed_;
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer service_;
};

}  // namespace posevote::ros1
