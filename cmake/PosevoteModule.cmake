# posevote_module(NAME [SOURCES ...] [PUBLIC libs] [PRIVATE libs] [TESTS *_test.cpp ...] [TEST_LIBS libs])
#
# One folder of src/posevote = one static library posevote_NAME (alias posevote::NAME), and one GoogleTest
# executable posevote_NAME_test of the tests that stand beside the sources. Headers are found as
# "posevote/NAME/x.hpp". All modules are joined in the installed library `posevote`.
function(posevote_module NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE;TESTS;TEST_LIBS" ${ARGN})
  add_library(posevote_${NAME} STATIC ${ARG_SOURCES})
  add_library(posevote::${NAME} ALIAS posevote_${NAME})
  target_include_directories(posevote_${NAME} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>)
  target_link_libraries(posevote_${NAME} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  posevote_compile_options(posevote_${NAME})
  posevote_precompile(posevote_${NAME} LIBRARY)
  set_property(GLOBAL APPEND PROPERTY POSEVOTE_MODULES posevote_${NAME})
  if(POSEVOTE_BUILD_TESTS AND ARG_TESTS)
    posevote_test(posevote_${NAME}_test SOURCES ${ARG_TESTS} LIBS posevote_${NAME} ${ARG_TEST_LIBS})
  endif()
endfunction()

# posevote_test(TARGET SOURCES ... LIBS ...): a GoogleTest executable, every case of it a CTest case.
function(posevote_test TARGET)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${TARGET} ${ARG_SOURCES})
  target_link_libraries(${TARGET} PRIVATE ${ARG_LIBS} GTest::gmock GTest::gtest_main)
  target_compile_definitions(${TARGET} PRIVATE
    POSEVOTE_SOURCE_DIR="${PROJECT_SOURCE_DIR}" POSEVOTE_BINARY_DIR="${PROJECT_BINARY_DIR}")
  posevote_compile_options(${TARGET})
  posevote_test_options(${TARGET})
  posevote_precompile(${TARGET} TESTS)
  gtest_discover_tests(${TARGET} DISCOVERY_TIMEOUT 120 PROPERTIES TIMEOUT 900)
endfunction()

# Tests take longer to optimise than they save by it; what they test is optimised all the same.
function(posevote_test_options TARGET)
  target_compile_options(${TARGET} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

function(posevote_compile_options TARGET)
  target_compile_options(${TARGET} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion)
  if(POSEVOTE_SANITIZE)
    target_compile_options(${TARGET} PRIVATE -fsanitize=${POSEVOTE_SANITIZE} -fno-omit-frame-pointer
      -fno-sanitize-recover=all)
    target_link_options(${TARGET} PUBLIC -fsanitize=${POSEVOTE_SANITIZE})
  endif()
endfunction()
