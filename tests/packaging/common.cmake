# For the scripts beside it.
set(prefix ${WORK}/prefix)

# run(WHAT COMMAND...): stops with all output when the command fails; leaves it in `output`.
macro(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${what} failed (${status}):\n${output}")
  endif()
endmacro()

# expect(TEXT REGEX): `output` must match.
macro(expect what regex)
  if(NOT output MATCHES "${regex}")
    message(FATAL_ERROR "${what}: expected ${regex} in\n${output}")
  endif()
endmacro()

# The first C++ block of README.md, as it stands there.
macro(extract_readme_example path)
  file(READ ${SOURCE}/README.md text)
  string(FIND "${text}" "```cpp\n" begin)
  if(begin EQUAL -1)
    message(FATAL_ERROR "README.md has no C++ example")
  endif()
  math(EXPR begin "${begin} + 7")
  string(SUBSTRING "${text}" ${begin} -1 text)
  string(FIND "${text}" "```" end)
  string(SUBSTRING "${text}" 0 ${end} text)
  file(WRITE ${path} "${text}")
endmacro()

# The example takes a picture of an object and one of a scene, and prints what it finds.
macro(run_readme_example program)
  run("the example" ${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${prefix}/${LIBDIR}
    ${program} ${SOURCE}/data/demo/train/poster/cover.jpg ${SOURCE}/data/demo/test/reading.jpg)
  expect("the example" "poster")
endmacro()
