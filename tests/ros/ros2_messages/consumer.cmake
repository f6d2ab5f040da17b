cmake_minimum_required(VERSION 3.16)
project(consumer C CXX)
set(CMAKE_CXX_STANDARD 17)
find_package(posevote_msgs REQUIRED)
add_subdirectory(${SOURCE}/ros/posevote_ros/logic logic)
add_executable(consumer ${SOURCE}/tests/ros/ros2_messages/consumer.cpp)
target_link_libraries(consumer PRIVATE posevote_ros_logic ${posevote_msgs_TARGETS})

# The same messages for a plain Cyclone DDS program.
find_package(CycloneDDS QUIET)
if(CycloneDDS_FOUND)
  set(interfaces ${posevote_msgs_DIR}/../..)
  set(files "")
  foreach(name builtin_interfaces/msg/Time std_msgs/msg/Header geometry_msgs/msg/Point
      geometry_msgs/msg/Quaternion geometry_msgs/msg/Pose posevote_msgs/msg/Point2
      posevote_msgs/msg/Box posevote_msgs/msg/Detection posevote_msgs/msg/DetectionArray)
    list(APPEND files ${interfaces}/${name}.idl)
  endforeach()
  idlc_generate(TARGET interfaces FILES ${files} INCLUDES ${interfaces} BASE_DIR ${interfaces}
    DEFAULT_EXTENSIBILITY final NO_TYPE_INFO)
  add_executable(wire ${SOURCE}/tests/ros/ros2_messages/wire.cpp)
  target_link_libraries(wire PRIVATE interfaces CycloneDDS::ddsc)
endif()
