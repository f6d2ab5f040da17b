# An empty CMake project uses the installed library; every installed header is valid C++17.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
set(consumer ${WORK}/consumer)
file(REMOVE_RECURSE ${consumer})
file(COPY ${CMAKE_CURRENT_LIST_DIR}/consumer/CMakeLists.txt DESTINATION ${consumer})
extract_readme_example(${consumer}/example.cpp)
run("configuring the consumer" ${CMAKE_COMMAND} -S ${consumer} -B ${consumer}/build -G ${GENERATOR}
  -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_CXX_COMPILER=${COMPILER} -D HEADERS=${prefix}/include)
run("building the consumer" ${CMAKE_COMMAND} --build ${consumer}/build)
if(WITH_SURF)
  run_readme_example(${consumer}/build/example)
endif()
