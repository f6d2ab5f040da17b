# posevote_precompile(TARGET TESTS|LIBRARY): with POSEVOTE_PRECOMPILE the headers that most files of
# that kind read are compiled once, for builds that are to be soon there. Other builds leave it out:
# it hides a header that is missing in a file.
function(posevote_precompile TARGET KIND)
  if(NOT POSEVOTE_PRECOMPILE)
    return()
  endif()
  set(host posevote_precompiled_${KIND})
  if(NOT TARGET ${host})
    set(source ${PROJECT_BINARY_DIR}/precompiled/${KIND}.cpp)
    if(KIND STREQUAL TESTS) # position-independent like a program: code of libraries differs
      file(CONFIGURE OUTPUT ${source} CONTENT "int main() {}\n")
      add_executable(${host} ${source})
      target_link_libraries(${host} PRIVATE ${OpenCV_LIBS} GTest::gmock)
      posevote_test_options(${host}) # else the tests cannot use what it compiles
      target_precompile_headers(${host} PRIVATE <gmock/gmock.h> <gtest/gtest.h>)
    else()
      file(CONFIGURE OUTPUT ${source} CONTENT "namespace posevote {}\n")
      add_library(${host} STATIC ${source})
      target_link_libraries(${host} PRIVATE ${OpenCV_LIBS})
    endif()
    target_precompile_headers(${host} PRIVATE
      <algorithm> <filesystem> <fstream> <functional> <map> <memory> <string> <vector>
      <opencv2/core.hpp> <opencv2/imgproc.hpp>)
    posevote_compile_options(${host})
  endif()
  target_precompile_headers(${TARGET} REUSE_FROM ${host})
endfunction()
