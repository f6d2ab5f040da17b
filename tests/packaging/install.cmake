# The whole project goes into an empty prefix.
include(${CMAKE_CURRENT_LIST_DIR}/common.cmake)
file(REMOVE_RECURSE ${prefix})
run("cmake --install" ${CMAKE_COMMAND} --install ${BINARY} --prefix ${prefix})
set(wanted include/posevote/recognize/recognizer.hpp include/posevote/opencv.hpp
  ${LIBDIR}/cmake/posevote/posevoteConfig.cmake ${LIBDIR}/pkgconfig/posevote.pc)
if(WITH_APPS)
  list(APPEND wanted bin/posevote share/man/man1/posevote.1
    share/bash-completion/completions/posevote)
endif()
foreach(file IN LISTS wanted)
  if(NOT EXISTS ${prefix}/${file})
    message(FATAL_ERROR "${file} was not installed")
  endif()
endforeach()
if(WITH_APPS)
  run("the installed program" ${prefix}/bin/posevote --version)
endif()
