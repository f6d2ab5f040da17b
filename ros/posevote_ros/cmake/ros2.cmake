# Component and executable, launch files.
find_package(ament_cmake REQUIRED)
set(used diagnostic_updater geometry_msgs posevote_msgs rclcpp rclcpp_action rclcpp_components
  rclcpp_lifecycle sensor_msgs std_msgs tf2_ros vision_msgs visualization_msgs)
foreach(package IN LISTS used)
  find_package(${package} REQUIRED)
endforeach()

add_library(posevote_ros_component SHARED
  ros2/camera_input.cpp
  ros2/convert.cpp
  ros2/node.cpp
  ros2/parameters.cpp
  ros2/services.cpp
  ros2/teach_action.cpp)
target_include_directories(posevote_ros_component PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(posevote_ros_component PRIVATE posevote_ros_logic)
ament_target_dependencies(posevote_ros_component PUBLIC ${used})
target_compile_options(posevote_ros_component PRIVATE -Wall -Wextra)
# The library posevote may be anywhere.
set_target_properties(posevote_ros_component PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
rclcpp_components_register_nodes(posevote_ros_component "posevote::ros2::Node")

add_executable(posevote_node ros2/main.cpp)
target_include_directories(posevote_node PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(posevote_node PRIVATE posevote_ros_component posevote_ros_logic)
set_target_properties(posevote_node PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)

install(TARGETS posevote_ros_component
  ARCHIVE DESTINATION lib LIBRARY DESTINATION lib RUNTIME DESTINATION bin)
install(TARGETS posevote_node RUNTIME DESTINATION lib/${PROJECT_NAME})
install(DIRECTORY launch rviz config DESTINATION share/${PROJECT_NAME}
  FILES_MATCHING PATTERN *.launch.py PATTERN ros2.rviz PATTERN *.yaml)
install(PROGRAMS scripts/import_pictures scripts/make_demo_bag.py scripts/studio
  DESTINATION lib/${PROJECT_NAME})

if(BUILD_TESTING)
  find_package(ament_cmake_ros REQUIRED)
  find_package(launch_testing_ament_cmake REQUIRED)
  get_filename_component(sources ${CMAKE_CURRENT_SOURCE_DIR} REALPATH) # a workspace has links
  set(POSEVOTE_DEMO ${sources}/../../data/demo
    CACHE PATH "posevote's folder data/demo, for the tests")
  find_program(POSEVOTE_PROGRAM posevote REQUIRED)
  get_filename_component(programs ${POSEVOTE_PROGRAM} DIRECTORY)
  foreach(name recognition teach_camera life_cycle bag slow_node)
    # In a domain of their own: they must not meet a robot's nodes.
    add_launch_test(test/ros2/${name}_test.py TARGET ${name} TIMEOUT 300
      RUNNER ${ament_cmake_ros_DIR}/run_test_isolated.py ENV POSEVOTE_DEMO=${POSEVOTE_DEMO}
      APPEND_ENV PATH=${programs} PYTHONPATH=${CMAKE_CURRENT_SOURCE_DIR}/test/ros2)
  endforeach()
endif()
ament_package()
