#include <exception>

#include "posevote/core/arguments.hpp"
#include "posevote/store/address.hpp"
#include "ros1/node.hpp"

int main(int argc, char** argv) {
  std::vector<std::string> arguments = posevote::take_arguments(argc, argv);
  std::vector<char*> words = posevote::argv_of(arguments);
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
