# One line of shell uses the installed library.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
find_program(PKG_CONFIG pkg-config REQUIRED)
set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
run("pkg-config" ${PKG_CONFIG} --cflags --libs posevote)
string(STRIP "${output}" flags)
separate_arguments(flags UNIX_COMMAND "${flags}")
extract_readme_example(${WORK}/pkg_config.cpp)
run("compiling with pkg-config's flags"
  ${COMPILER} -std=c++17 ${WORK}/pkg_config.cpp -o ${WORK}/pkg_config ${flags})
if(WITH_SURF)
  run_readme_example(${WORK}/pkg_config)
endif()
