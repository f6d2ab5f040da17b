# For the scripts beside it. ROS must neither find another workspace nor write into the user's home.
set(ENV{PATH} /usr/bin:$ENV{PATH}) # ROS's Python is the system's
set(ENV{ROS_HOSTNAME} localhost)
set(ENV{ROS_HOME} ${WORK}/ros_home)
set(ENV{LC_ALL} C.UTF-8)
foreach(variable CMAKE_PREFIX_PATH ROS_PACKAGE_PATH AMENT_PREFIX_PATH ROS_MASTER_URI ROS_LOG_DIR)
  unset(ENV{${variable}})
endforeach()
set(options -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})

# run(WHAT COMMAND...): stops with all output when the command fails; leaves it in `output`.
macro(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${what} failed (${status}):\n${output}")
  endif()
endmacro()
