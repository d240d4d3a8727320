# SPDX-License-Identifier: BSD-3-Clause
# Everything the ROS side stands on. Foreign headers are SYSTEM: their warnings are not ours.

find_package(catkin REQUIRED COMPONENTS
  geometric_shapes geometry_msgs message_generation nodelet pluginlib roscpp roslib sensor_msgs shape_msgs std_msgs tf2
  tf2_eigen tf2_ros urdf visualization_msgs)
find_package(Eigen3 REQUIRED)
find_package(PkgConfig REQUIRED)

# CPROX_FCL: 0.7 brings a CMake package with a target, 0.5 a CMake package with variables or only fcl.pc.
find_package(fcl QUIET CONFIG)
if(TARGET fcl)
  set(CPROX_FCL_LIBRARIES fcl)
  set(CPROX_FCL_INCLUDE_DIRS ${FCL_INCLUDE_DIRS})
  set(cprox_fcl_how "its CMake package")
  set(cprox_fcl_version ${fcl_VERSION})
else()
  pkg_check_modules(FCL_PC fcl)
  if(NOT FCL_PC_FOUND)
    message(FATAL_ERROR "FCL was found neither as a CMake package nor by pkg-config: install libfcl-dev")
  endif()
  set(CPROX_FCL_LIBRARIES ${FCL_PC_LINK_LIBRARIES})
  set(CPROX_FCL_INCLUDE_DIRS ${FCL_PC_INCLUDE_DIRS})
  set(cprox_fcl_how "pkg-config")
  set(cprox_fcl_version ${FCL_PC_VERSION})
endif()
if(NOT cprox_fcl_version MATCHES "^0\\.[567]")
  message(FATAL_ERROR "FCL ${cprox_fcl_version} is not known here: 0.5, 0.6 and 0.7 are")
endif()
message(STATUS "FCL ${cprox_fcl_version}, found by ${cprox_fcl_how}")

pkg_check_modules(CPROX_CCD REQUIRED ccd)
pkg_check_modules(CPROX_YAML REQUIRED yaml-cpp)
# Variables that catkin_package(DEPENDS ...) hands on: absolute library files, so that no -L is needed.
set(CPROX_CCD_LIBRARIES ${CPROX_CCD_LINK_LIBRARIES})
set(CPROX_YAML_LIBRARIES ${CPROX_YAML_LINK_LIBRARIES})
if(NOT CPROX_CCD_INCLUDE_DIRS)
  set(CPROX_CCD_INCLUDE_DIRS ${CPROX_CCD_INCLUDEDIR})
endif()
if(NOT CPROX_YAML_INCLUDE_DIRS)
  set(CPROX_YAML_INCLUDE_DIRS ${CPROX_YAML_INCLUDEDIR})
endif()

# One interface target each.
function(cprox_dependency name)
  cmake_parse_arguments(arg "" "" "INCLUDES;LIBRARIES" ${ARGN})
  add_library(${name} INTERFACE)
  target_include_directories(${name} SYSTEM INTERFACE ${arg_INCLUDES})
  target_link_libraries(${name} INTERFACE ${arg_LIBRARIES})
endfunction()
cprox_dependency(cprox_catkin INCLUDES ${catkin_INCLUDE_DIRS} LIBRARIES ${catkin_LIBRARIES})
cprox_dependency(cprox_fcl INCLUDES ${CPROX_FCL_INCLUDE_DIRS} ${EIGEN3_INCLUDE_DIRS} LIBRARIES ${CPROX_FCL_LIBRARIES})
cprox_dependency(cprox_ccd INCLUDES ${CPROX_CCD_INCLUDE_DIRS} LIBRARIES ${CPROX_CCD_LIBRARIES})
cprox_dependency(cprox_yaml INCLUDES ${CPROX_YAML_INCLUDE_DIRS} LIBRARIES ${CPROX_YAML_LIBRARIES})
