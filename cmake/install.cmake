# SPDX-License-Identifier: BSD-3-Clause
# What `catkin_make install` or `cmake --install` lays down.
include(CMakePackageConfigHelpers)

# The core and the Fourier gaps on top of it: libraries, C headers, a CMake package with the component `fourier`, and a
# pkg-config file each; all relocatable.
# Before 1.0 a new minor version may break the ABI, so that the SONAME carries it: of these libraries and of those above them.
set(linked_libraries cprox cprox_fourier)
if(CPROX_SCENE)
  list(APPEND linked_libraries ${PROJECT_NAME}_scene)
endif()
if(CPROX_ROS)
  list(APPEND linked_libraries ${PROJECT_NAME}_constraints ${PROJECT_NAME}_ros)
endif()
set_target_properties(${linked_libraries} PROPERTIES
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
install(TARGETS cprox EXPORT cproxTargets LIBRARY DESTINATION ${CPROX_LIB_DIR} ARCHIVE DESTINATION ${CPROX_LIB_DIR}
        RUNTIME DESTINATION bin)
install(TARGETS cprox_fourier EXPORT cprox_fourierTargets LIBRARY DESTINATION ${CPROX_LIB_DIR}
        ARCHIVE DESTINATION ${CPROX_LIB_DIR} RUNTIME DESTINATION bin)
install(EXPORT cproxTargets NAMESPACE cprox:: DESTINATION ${CPROX_LIB_DIR}/cmake/cprox)
install(EXPORT cprox_fourierTargets NAMESPACE cprox:: DESTINATION ${CPROX_LIB_DIR}/cmake/cprox)
configure_file(cmake/cproxConfig.cmake.in ${PROJECT_BINARY_DIR}/cproxConfig.cmake COPYONLY)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cproxConfigVersion.cmake COMPATIBILITY SameMinorVersion)
#catkin_lint: ignore_once missing_file wrong_install_destination
install(FILES ${PROJECT_BINARY_DIR}/cproxConfig.cmake ${PROJECT_BINARY_DIR}/cproxConfigVersion.cmake
        DESTINATION ${CPROX_LIB_DIR}/cmake/cprox)
file(RELATIVE_PATH CPROX_PC_PREFIX /${CPROX_LIB_DIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" CPROX_PC_PREFIX "${CPROX_PC_PREFIX}")
configure_file(cmake/cprox.pc.in ${PROJECT_BINARY_DIR}/cprox.pc @ONLY)
configure_file(cmake/cprox_fourier.pc.in ${PROJECT_BINARY_DIR}/cprox_fourier.pc @ONLY)
#catkin_lint: ignore_once wrong_install_destination
install(FILES ${PROJECT_BINARY_DIR}/cprox.pc ${PROJECT_BINARY_DIR}/cprox_fourier.pc DESTINATION ${CPROX_LIB_DIR}/pkgconfig)

install(DIRECTORY include/curve_proximity/ DESTINATION include/curve_proximity FILES_MATCHING PATTERN "*.h")
# The C++ classes over the core alone need Eigen, and parallel.hpp threads; they are headers.
install(FILES include/curve_proximity/core.hpp include/curve_proximity/fourier.hpp include/curve_proximity/parallel.hpp DESTINATION include/curve_proximity)

# The scene library, the program that reads meshes for it, and the Python package. A static scene library serves the Python
# package alone: whoever links it would need all that it needs.
if(CPROX_SCENE)
  #catkin_lint: ignore_once wrong_install_destination
  install(TARGETS ${PROJECT_NAME}_mesh_reader RUNTIME DESTINATION ${CPROX_PROGRAM_DIR})
  # pybind11_add_module() makes it.
  #catkin_lint: ignore_once undefined_target wrong_install_destination
  install(TARGETS cprox_python LIBRARY DESTINATION ${CPROX_PYTHON_DIR}/cprox)
  if(CPROX_ROS OR BUILD_SHARED_LIBS)
    install(TARGETS ${PROJECT_NAME}_scene EXPORT cprox_sceneTargets
            LIBRARY DESTINATION ${CPROX_LIB_DIR} ARCHIVE DESTINATION ${CPROX_LIB_DIR})
    install(EXPORT cprox_sceneTargets NAMESPACE cprox:: DESTINATION ${CPROX_LIB_DIR}/cmake/cprox)
  endif()
endif()
if(CPROX_SCENE AND NOT CPROX_ROS)
  #catkin_lint: ignore_once wrong_install_destination
  install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION include/${PROJECT_NAME} FILES_MATCHING PATTERN "*.hpp"
          PATTERN client.hpp EXCLUDE PATTERN "constraint_*.hpp" EXCLUDE)
  #catkin_lint: ignore_once wrong_install_destination
  install(DIRECTORY src/python/cprox src/python/cprox_dask DESTINATION ${CPROX_PYTHON_DIR} FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN py.typed)
endif()

# The ROS side.
if(CPROX_ROS)
  install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION}
          FILES_MATCHING PATTERN "*.hpp")
  install(TARGETS ${PROJECT_NAME}_constraints ${PROJECT_NAME}_providers ${PROJECT_NAME}_ros
          LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION} ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
  install(TARGETS ${PROJECT_NAME}_node RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  # The command line belongs on the PATH of whoever sources the space.
  set_target_properties(cprox_cli PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_BIN_DESTINATION})
  install(TARGETS cprox_cli RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
  #catkin_lint: ignore_once missing_file wrong_install_destination
  install(FILES ${PROJECT_BINARY_DIR}/cprox.1 DESTINATION share/man/man1)
  # Where cprox looks for it.
  set_target_properties(cprox_check PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_BIN_DESTINATION})
  install(TARGETS cprox_check RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
  catkin_install_python(PROGRAMS nodes/play_trajectory.py nodes/stand_still.py nodes/urdf_for_rviz.py
    nodes/keep_running.py nodes/show_in_rviz.py DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  install(DIRECTORY launch config rviz DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
  install(FILES collision_plugins.xml constraint_provider_plugins.xml move_group_capability_plugins.xml nodelet_plugins.xml
                planning_request_adapter_plugins.xml
          DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
  # The demo's robot and scenes, so that demo.launch works from the install space too.
  install(DIRECTORY test/data/robots test/data/scenes test/data/trajectories
          DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/test/data)
  install(FILES examples/tool.csv DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/examples)
else()
  if(TARGET cprox_check)
    install(TARGETS cprox_check RUNTIME DESTINATION bin)
  endif()
  if(CPROX_SCENE AND BUILD_SHARED_LIBS)
    set_target_properties(cprox_cli PROPERTIES INSTALL_RPATH "$ORIGIN/../${CPROX_LIB_DIR}")
    install(TARGETS cprox_cli RUNTIME DESTINATION bin)
    #catkin_lint: ignore_once missing_file wrong_install_destination
    install(FILES ${PROJECT_BINARY_DIR}/cprox.1 DESTINATION share/man/man1)
  endif()
endif()
