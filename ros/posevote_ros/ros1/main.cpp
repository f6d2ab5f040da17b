#include <exception>

#include "posevote/store/address.hpp"
#include "ros1/node.hpp"

int main(int argc, char** argv) {
  std::vector<std::string> arguments = posevote::take_arguments(argc, argv);
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  ros::init(argc, words.data(), "posevote");
  try {
    posevote::ros1::Node node(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::MultiThreadedSpinner(4).spin();
    return 0;
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
