#include <exception>

#include "ros1/node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "posevote");
  try {
    posevote::ros1::Node node(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::MultiThreadedSpinner(4).spin();
    return 0;
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
