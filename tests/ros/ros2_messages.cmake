# The message package as ROS 2 builds it, with Debian's generators. Debian has none of ROS 2's own
# message packages, so those parts of them that are used stand here. Then the node logic's
# conversions are compiled with the messages, and run.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
set(ENV{ROS_VERSION} 2)
file(REMOVE_RECURSE ${WORK})
set(installed ${WORK}/installed)

# interface(PACKAGE FILE TEXT)
function(interface package file text)
  file(WRITE ${WORK}/src/${package}/${file} "${text}")
endfunction()

function(build package source)
  run("configuring ${package}" ${CMAKE_COMMAND} -S ${source} -B ${WORK}/build/${package} ${options}
    -G Ninja -DCMAKE_INSTALL_PREFIX=${installed} -DCMAKE_PREFIX_PATH=${installed}
    -DBUILD_TESTING=OFF -DPython3_EXECUTABLE=/usr/bin/python3 ${ARGN})
  run("building ${package}" ${CMAKE_COMMAND} --build ${WORK}/build/${package})
  run("installing ${package}" ${CMAKE_COMMAND} --install ${WORK}/build/${package})
endfunction()

# package(NAME DEPENDENCIES...): builds the interfaces written so far.
function(package package)
  set(used ${ARGN})
  set(depends "")
  foreach(other IN LISTS used)
    string(APPEND depends "  <depend>${other}</depend>\n")
  endforeach()
  string(REPLACE ";" " " used "${used}")
  set(templates ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/ros2_messages)
  configure_file(${templates}/CMakeLists.txt.in ${WORK}/src/${package}/CMakeLists.txt @ONLY)
  configure_file(${templates}/package.xml.in ${WORK}/src/${package}/package.xml @ONLY)
  build(${package} ${WORK}/src/${package})
endfunction()

interface(builtin_interfaces msg/Time.msg "int32 sec\nuint32 nanosec\n")
package(builtin_interfaces)

interface(unique_identifier_msgs msg/UUID.msg "uint8[16] uuid\n")
package(unique_identifier_msgs)

interface(action_msgs msg/GoalInfo.msg
  "unique_identifier_msgs/UUID goal_id\nbuiltin_interfaces/Time stamp\n")
interface(action_msgs msg/GoalStatus.msg "action_msgs/GoalInfo goal_info\nint8 status\n")
interface(action_msgs msg/GoalStatusArray.msg "action_msgs/GoalStatus[] status_list\n")
interface(action_msgs srv/CancelGoal.srv
  "action_msgs/GoalInfo goal_info\n---\nint8 return_code\naction_msgs/GoalInfo[] goals_canceling\n")
package(action_msgs builtin_interfaces unique_identifier_msgs)

interface(std_msgs msg/Header.msg "builtin_interfaces/Time stamp\nstring frame_id\n")
package(std_msgs builtin_interfaces)

interface(geometry_msgs msg/Point.msg "float64 x\nfloat64 y\nfloat64 z\n")
interface(geometry_msgs msg/Quaternion.msg "float64 x\nfloat64 y\nfloat64 z\nfloat64 w 1\n")
interface(geometry_msgs msg/Pose.msg "Point position\nQuaternion orientation\n")
package(geometry_msgs)

interface(sensor_msgs msg/Image.msg "std_msgs/Header header\nuint32 height\nuint32 width\n\
string encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data\n")
interface(sensor_msgs msg/RegionOfInterest.msg
  "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n")
interface(sensor_msgs msg/CameraInfo.msg "std_msgs/Header header\nuint32 height\nuint32 width\n\
string distortion_model\nfloat64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\n\
uint32 binning_x\nuint32 binning_y\nRegionOfInterest roi\n")
package(sensor_msgs builtin_interfaces std_msgs)

build(posevote_msgs ${SOURCE}/ros/posevote_msgs)
foreach(file msg/Detection.msg srv/Detect.srv action/Teach.action package.xml)
  if(NOT EXISTS ${installed}/share/posevote_msgs/${file})
    message(FATAL_ERROR "share/posevote_msgs/${file} was not installed")
  endif()
endforeach()

file(COPY_FILE ${CMAKE_CURRENT_LIST_DIR}/ros2_messages/consumer.cmake ${WORK}/consumer.txt)
file(MAKE_DIRECTORY ${WORK}/consumer)
file(RENAME ${WORK}/consumer.txt ${WORK}/consumer/CMakeLists.txt)
run("configuring the consumer" ${CMAKE_COMMAND} -S ${WORK}/consumer -B ${WORK}/build/consumer
  ${options} -G Ninja -DSOURCE=${SOURCE} -DCMAKE_BUILD_TYPE=Release
  "-DCMAKE_PREFIX_PATH=${installed}\\;${PREFIX}" -DPython3_EXECUTABLE=/usr/bin/python3)
run("building the consumer" ${CMAKE_COMMAND} --build ${WORK}/build/consumer)
run("the consumer" ${CMAKE_COMMAND} -E env
  LD_LIBRARY_PATH=${installed}/lib:${PREFIX}/${LIBDIR}
  ${WORK}/build/consumer/consumer ${SOURCE}/data/demo ${WORK})

# Without Cyclone DDS it is not there.
if(EXISTS ${WORK}/build/consumer/wire)
  set(ENV{CYCLONEDDS_URI} "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name='lo'/>\
</Interfaces></General></Domain></CycloneDDS>")
  run("the message on the wire" ${WORK}/build/consumer/wire
    ${CMAKE_CURRENT_LIST_DIR}/ros2_messages/detections.cdr)
endif()
