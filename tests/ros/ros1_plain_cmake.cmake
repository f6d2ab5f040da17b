# Without catkin's own commands and without vision_msgs, with the workspace's sources and messages;
# then installed.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
set(ENV{ROS_VERSION} 1)
file(REMOVE_RECURSE ${WORK})
set(workspace ${WORK}/../ros1_workspace/devel)
run("configuring" ${CMAKE_COMMAND} -S ${workspace}/../src/posevote_ros -B ${WORK}/build ${options}
  "-DCMAKE_PREFIX_PATH=${workspace}\\;${PREFIX}" -DCMAKE_BUILD_TYPE=Release -DCMAKE_DISABLE_FIND_PACKAGE_vision_msgs=ON
  -DCMAKE_INSTALL_PREFIX=${WORK}/installed)
run("building" ${CMAKE_COMMAND} --build ${WORK}/build)
run("installing" ${CMAKE_COMMAND} --install ${WORK}/build)
foreach(file lib/posevote_ros/posevote_node lib/posevote_ros/make_demo_bag.py
    lib/libposevote_ros_node.so share/posevote_ros/nodelet_plugins.xml
    share/posevote_ros/launch/posevote.launch share/posevote_ros/rviz/ros1.rviz)
  if(NOT EXISTS ${WORK}/installed/${file})
    message(FATAL_ERROR "${file} was not installed")
  endif()
endforeach()
