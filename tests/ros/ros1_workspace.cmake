# Both packages in a catkin workspace, as a robot team builds them, and their rostests.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
set(ENV{ROS_VERSION} 1)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/src)
foreach(package posevote_msgs posevote_ros)
  file(CREATE_LINK ${SOURCE}/ros/${package} ${WORK}/src/${package} SYMBOLIC)
endforeach()

# Debian has no vision_msgs: those of ROS Noetic that are used, word for word.
function(write_message name)
  string(JOIN "\n" text ${ARGN})
  file(WRITE ${WORK}/src/vision_msgs/msg/${name}.msg "${text}\n")
endfunction()
write_message(BoundingBox2D "geometry_msgs/Pose2D center" "float64 size_x" "float64 size_y")
write_message(BoundingBox3D "geometry_msgs/Pose center" "geometry_msgs/Vector3 size")
write_message(ObjectHypothesisWithPose "int64 id" "float64 score" "geometry_msgs/PoseWithCovariance pose")
write_message(Detection2D "Header header" "ObjectHypothesisWithPose[] results" "BoundingBox2D bbox"
  "sensor_msgs/Image source_img")
write_message(Detection2DArray "Header header" "Detection2D[] detections")
write_message(Detection3D "Header header" "ObjectHypothesisWithPose[] results" "BoundingBox3D bbox"
  "sensor_msgs/PointCloud2 source_cloud")
write_message(Detection3DArray "Header header" "Detection3D[] detections")
file(COPY ${CMAKE_CURRENT_LIST_DIR}/ros1_vision_msgs/ DESTINATION ${WORK}/src/vision_msgs)

cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
run("catkin_make" catkin_make -C ${WORK} -j${cores} ${options} -DCMAKE_PREFIX_PATH=${PREFIX}
  -DCMAKE_BUILD_TYPE=Release -DPOSEVOTE_DEMO=${SOURCE}/data/demo)
foreach(file lib/posevote_ros/posevote_node lib/libposevote_ros_node.so)
  if(NOT EXISTS ${WORK}/devel/${file})
    message(FATAL_ERROR "${file} was not built")
  endif()
endforeach()

# run_tests succeeds whatever the tests do; catkin_test_results does not.
run("catkin_make run_tests" catkin_make -C ${WORK} -j1 run_tests)
set(log "${output}")
execute_process(COMMAND catkin_test_results --verbose ${WORK}/build/test_results
  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "catkin_test_results:\n${output}\n${log}")
endif()
file(GLOB_RECURSE results ${WORK}/build/test_results/*/rosunit-*.xml)
list(LENGTH results count)
if(NOT count EQUAL 4)
  message(FATAL_ERROR "4 tests should have left results, not ${count}:\n${log}")
endif()
