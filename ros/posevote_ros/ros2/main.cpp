#include "posevote/core/arguments.hpp"
#include "posevote/store/address.hpp"
#include "ros2/node.hpp"

int main(int argc, char** argv) {
  std::vector<std::string> arguments = posevote::take_arguments(argc, argv);
  rclcpp::init(argc, posevote::argv_of(arguments).data());
  rclcpp::spin(
      std::make_shared<posevote::ros2::Node>(rclcpp::NodeOptions())->get_node_base_interface());
  rclcpp::shutdown();
  return 0;
}
