# Joins the modules in the one library that is installed, and installs it with everything that lets
# other programs find it: headers, CMake package, pkg-config file, Debian package.
include(CMakePackageConfigHelpers)

option(BUILD_SHARED_LIBS "Install a shared library; OFF: a static one, which needs more packages to link" ON)

get_property(posevote_modules GLOBAL PROPERTY POSEVOTE_MODULES)
set(posevote_objects)
foreach(module IN LISTS posevote_modules)
  list(APPEND posevote_objects $<TARGET_OBJECTS:${module}>)
endforeach()

# The program is the target `posevote`, so the library has another name here; users see posevote::posevote.
add_library(posevote_library ${posevote_objects})
set_target_properties(posevote_library PROPERTIES
  OUTPUT_NAME posevote EXPORT_NAME posevote LINKER_LANGUAGE CXX
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_include_directories(posevote_library INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(posevote_library INTERFACE cxx_std_17)
posevote_compile_options(posevote_library)

# What the headers show is public; the rest concerns users of the static library only.
set(posevote_opencv core imgproc calib3d imgcodecs features2d flann)
set(posevote_private Threads::Threads)
set(posevote_private_packages Threads)
set(posevote_private_flags -pthread)
macro(posevote_private_package NAME LIBRARY FLAGS)
  find_package(${NAME} REQUIRED)
  list(APPEND posevote_private ${LIBRARY})
  list(APPEND posevote_private_packages ${NAME})
  list(APPEND posevote_private_flags ${FLAGS})
endmacro()

find_package(Threads REQUIRED)
if(POSEVOTE_WITH_VIDEO)
  list(APPEND posevote_opencv videoio)
endif()
find_package(OpenCV 4.5 REQUIRED COMPONENTS ${posevote_opencv} OPTIONAL_COMPONENTS freetype)
list(TRANSFORM posevote_opencv PREPEND opencv_ OUTPUT_VARIABLE posevote_public)
if(TARGET posevote_json)
  find_package(nlohmann_json 3.10 REQUIRED)
  list(APPEND posevote_public nlohmann_json::nlohmann_json)
  set(posevote_public_packages nlohmann_json)
endif()
if(TARGET opencv_freetype AND TARGET posevote_render)
  list(APPEND posevote_private opencv_freetype)
  list(APPEND posevote_private_flags -lopencv_freetype)
endif()
find_package(hwy QUIET)
if(hwy_FOUND)
  posevote_private_package(hwy hwy::hwy -lhwy)
endif()
if(TARGET posevote_store)
  posevote_private_package(SQLiteCpp SQLiteCpp -lSQLiteCpp)
  posevote_private_package(SQLite3 SQLite::SQLite3 -lsqlite3)
  posevote_private_package(OpenSSL OpenSSL::Crypto -lcrypto)
  if(POSEVOTE_WITH_POSTGRES)
    list(APPEND posevote_private pqxx)
    list(APPEND posevote_private_flags -lpqxx)
  endif()
endif()
target_link_libraries(posevote_library PUBLIC ${posevote_public} PRIVATE ${posevote_private})

install(TARGETS posevote_library EXPORT posevoteTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})

# Headers of the modules' own folders are public; deeper folders and these few are the library's own
# business, and need C++20 or a dependency's headers.
set(posevote_internal "/(made_[a-z_]+|object_store_contract|paper_parts|core/bytes|index/parallel|index/each_target)\\.hpp$")
foreach(module IN LISTS posevote_modules)
  string(REGEX REPLACE "^posevote_" "" folder ${module})
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/posevote/${folder}/*.hpp)
  list(FILTER headers EXCLUDE REGEX ${posevote_internal})
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/posevote/${folder})
endforeach()
install(FILES src/posevote/opencv.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/posevote)
if(TARGET posevote_store)
  install(FILES src/posevote/store/sqlite/sqlite_store.hpp
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/posevote/store/sqlite)
  if(POSEVOTE_WITH_POSTGRES)
    install(FILES src/posevote/store/postgres/postgres_store.hpp
      DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/posevote/store/postgres)
  endif()
endif()

# find_package(posevote)
set(posevote_package ${CMAKE_INSTALL_LIBDIR}/cmake/posevote)
string(REPLACE ";" " " POSEVOTE_OPENCV_COMPONENTS "${posevote_opencv}")
set(posevote_packages ${posevote_public_packages})
if(NOT BUILD_SHARED_LIBS)
  list(APPEND posevote_packages ${posevote_private_packages})
endif()
string(REPLACE ";" " " POSEVOTE_PACKAGES "${posevote_packages}")
configure_package_config_file(cmake/posevoteConfig.cmake.in posevoteConfig.cmake
  INSTALL_DESTINATION ${posevote_package})
write_basic_package_version_file(posevoteConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/posevoteConfig.cmake ${PROJECT_BINARY_DIR}/posevoteConfigVersion.cmake
  DESTINATION ${posevote_package})
install(EXPORT posevoteTargets NAMESPACE posevote:: DESTINATION ${posevote_package})

# pkg-config
list(TRANSFORM posevote_opencv PREPEND -lopencv_ OUTPUT_VARIABLE posevote_flags)
if(NOT BUILD_SHARED_LIBS)
  list(APPEND posevote_flags ${posevote_private_flags})
endif()
list(JOIN posevote_flags " " POSEVOTE_LIBS)
set(POSEVOTE_REQUIRES opencv4)
if(TARGET posevote_json)
  string(APPEND POSEVOTE_REQUIRES " nlohmann_json")
endif()
file(RELATIVE_PATH POSEVOTE_PREFIX_FROM_PC /p/${CMAKE_INSTALL_LIBDIR}/pkgconfig /p)
string(REGEX REPLACE "/$" "" POSEVOTE_PREFIX_FROM_PC ${POSEVOTE_PREFIX_FROM_PC})
configure_file(cmake/posevote.pc.in posevote.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/posevote.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)

# cpack -G DEB
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "The posevote authors")
set(CPACK_PACKAGE_CONTACT "The posevote authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS fonts-dejavu-core)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libopencv-dev, nlohmann-json3-dev")
set(CPACK_DEB_COMPONENT_INSTALL ON)
get_cmake_property(CPACK_COMPONENTS_ALL COMPONENTS)
set(CPACK_DEBIAN_POSEVOTE_PACKAGE_NAME posevote)
if(TARGET posevote_python)
  math(EXPR next "${POSEVOTE_PYTHON_MINOR} + 1")
  set(CPACK_DEBIAN_POSEVOTE_PACKAGE_RECOMMENDS
    "${CPACK_DEBIAN_PACKAGE_RECOMMENDS}, python3-posevote") # posevote batch
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-posevote)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_GENERATE_SHLIBS OFF) # a module is no library to link with
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${POSEVOTE_PYTHON_MINOR}), python3 (<< 3.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS python3-distributed)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-opencv)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python package of posevote")
endif()
include(CPack)
