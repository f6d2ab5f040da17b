# posevote_embed(TARGET FUNCTION FOLDER [DEPENDS files])
#
# Puts every file of FOLDER (looked up when building) into TARGET, which gets a function FUNCTION that
# returns them (apps/server/embedded.hpp). The folder may be made by the build: name in DEPENDS what
# makes it.
function(posevote_embed TARGET FUNCTION FOLDER)
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${FUNCTION}.cpp)
  add_custom_command(OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -DFOLDER=${FOLDER} -DFUNCTION=${FUNCTION} -DOUTPUT=${source}
      -P ${PROJECT_SOURCE_DIR}/cmake/embed_folder.cmake
    DEPENDS ${PROJECT_SOURCE_DIR}/cmake/embed_folder.cmake ${ARG_DEPENDS}
    COMMENT "Embedding ${FUNCTION}" VERBATIM)
  target_sources(${TARGET} PRIVATE ${source})
endfunction()
