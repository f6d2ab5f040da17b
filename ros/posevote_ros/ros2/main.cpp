#include "posevote/store/address.hpp"
#include "ros2/node.hpp"

int main(int argc, char** argv) {
  const std::vector<std::string> arguments = posevote::take_arguments(argc, argv);
  std::vector<const char*> words;
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  words.push_back(nullptr);
  rclcpp::init(argc, words.data());
  rclcpp::spin(
      std::make_shared<posevote::ros2::Node>(rclcpp::NodeOptions())->get_node_base_interface());
  rclcpp::shutdown();
  return 0;
}
