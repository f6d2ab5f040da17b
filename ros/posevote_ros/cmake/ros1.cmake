# Node and nodelet, launch files, tests.
set(used actionlib diagnostic_updater dynamic_reconfigure geometry_msgs image_transport nodelet
  pluginlib posevote_msgs roscpp sensor_msgs std_msgs tf2_ros visualization_msgs)
find_package(catkin REQUIRED COMPONENTS ${used})
catkin_package(CATKIN_DEPENDS ${used})

add_library(posevote_ros_node
  ros1/camera_input.cpp
  ros1/convert.cpp
  ros1/node.cpp
  ros1/nodelet.cpp
  ros1/parameters.cpp
  ros1/services.cpp
  ros1/teach_action.cpp
  ros1/vision.cpp)
target_include_directories(posevote_ros_node PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_include_directories(posevote_ros_node SYSTEM PUBLIC ${catkin_INCLUDE_DIRS})
target_link_libraries(posevote_ros_node PUBLIC posevote_ros_logic ${catkin_LIBRARIES})
target_compile_options(posevote_ros_node PRIVATE -Wall -Wextra)
add_dependencies(posevote_ros_node ${catkin_EXPORTED_TARGETS})

find_package(vision_msgs QUIET) # not in Debian
if(vision_msgs_FOUND)
  target_compile_definitions(posevote_ros_node PRIVATE POSEVOTE_WITH_VISION_MSGS)
  target_include_directories(posevote_ros_node SYSTEM PRIVATE ${vision_msgs_INCLUDE_DIRS})
  if(vision_msgs_EXPORTED_TARGETS) # in the same workspace
    add_dependencies(posevote_ros_node ${vision_msgs_EXPORTED_TARGETS})
  endif()
endif()

add_executable(posevote_node ros1/main.cpp)
target_link_libraries(posevote_node PRIVATE posevote_ros_node)

install(TARGETS posevote_ros_node
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
install(TARGETS posevote_node RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(FILES nodelet_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
install(DIRECTORY launch DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}
  FILES_MATCHING PATTERN *.launch)
install(DIRECTORY rviz DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION} FILES_MATCHING PATTERN *.rviz)
install(PROGRAMS scripts/import_pictures scripts/make_demo_bag.py scripts/studio
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})

if(CATKIN_ENABLE_TESTING)
  find_package(rostest REQUIRED)
  set(POSEVOTE_DEMO ${CMAKE_CURRENT_SOURCE_DIR}/../../data/demo
    CACHE PATH "posevote's folder data/demo, for the tests")
  get_filename_component(demo ${POSEVOTE_DEMO} ABSOLUTE)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/rostest)
  file(REMOVE_RECURSE ${folder})
  file(MAKE_DIRECTORY ${folder})
  foreach(name recognition teach_camera bag slow_node)
    add_rostest(test/ros1/${name}.test ARGS demo:=${demo} folder:=${folder}
      DEPENDENCIES posevote_node)
  endforeach()
endif()
