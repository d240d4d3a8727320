# SPDX-License-Identifier: BSD-3-Clause
# What the scene library and the Python package stand on, found once; dependency_targets.cmake makes targets of it.

find_package(Eigen3 REQUIRED)

# The Python package: pybind11 builds for the Python that catkin uses, or for -DPython3_EXECUTABLE.
if(CPROX_ROS)
  set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE})
endif()
find_package(Python3 REQUIRED COMPONENTS Interpreter Development)
if(Python_FOUND) # by Debian 13's catkin, without what pybind11 then asks of it
  find_package(Python REQUIRED COMPONENTS Interpreter Development)
endif()
find_package(pybind11 REQUIRED CONFIG)

# FCL: 0.6 and 0.7 bring a CMake package with a target; 0.5 is asked for by pkg-config.
find_package(fcl QUIET CONFIG)
if(TARGET fcl)
  set(CPROX_FCL_LIBRARIES fcl)
  set(CPROX_FCL_INCLUDE_DIRS ${FCL_INCLUDE_DIRS})
  set(CPROX_FCL_VERSION ${fcl_VERSION})
  set(CPROX_FCL_FOUND_BY "its CMake package")
else()
  pkg_check_modules(PC_FCL fcl)
  if(NOT PC_FCL_FOUND)
    message(FATAL_ERROR "FCL was found neither as a CMake package nor by pkg-config: install libfcl-dev")
  endif()
  set(CPROX_FCL_LIBRARIES ${PC_FCL_LINK_LIBRARIES})
  set(CPROX_FCL_INCLUDE_DIRS ${PC_FCL_INCLUDEDIR} ${PC_FCL_INCLUDE_DIRS})
  set(CPROX_FCL_VERSION ${PC_FCL_VERSION})
  set(CPROX_FCL_FOUND_BY "pkg-config")
endif()
if(NOT CPROX_FCL_VERSION MATCHES "^0\\.[567]")
  message(FATAL_ERROR "FCL ${CPROX_FCL_VERSION} is not known here: 0.5, 0.6 and 0.7 are")
endif()
message(STATUS "FCL ${CPROX_FCL_VERSION}, found by ${CPROX_FCL_FOUND_BY}")

# The rest by pkg-config, as absolute library files: whoever links us needs no -L.
pkg_check_modules(PC_YAML REQUIRED yaml-cpp)
set(CPROX_YAML_LIBRARIES ${PC_YAML_LINK_LIBRARIES})
set(CPROX_YAML_INCLUDE_DIRS ${PC_YAML_INCLUDEDIR} ${PC_YAML_INCLUDE_DIRS})
pkg_check_modules(PC_CCD REQUIRED ccd)
set(CPROX_CCD_LIBRARIES ${PC_CCD_LINK_LIBRARIES})
set(CPROX_CCD_INCLUDE_DIRS ${PC_CCD_INCLUDEDIR} ${PC_CCD_INCLUDE_DIRS})
pkg_check_modules(PC_OCTOMAP REQUIRED octomap)
pkg_check_modules(PC_URDFDOM REQUIRED urdfdom)
pkg_check_modules(PC_TINYXML2 REQUIRED tinyxml2)
pkg_check_modules(PC_CONSOLE_BRIDGE REQUIRED console_bridge) # with urdfdom
# RapidJSON is headers alone; not every version brings a pkg-config file.
find_path(CPROX_RAPIDJSON_INCLUDE_DIR rapidjson/document.h)
mark_as_advanced(CPROX_RAPIDJSON_INCLUDE_DIR)
if(NOT CPROX_RAPIDJSON_INCLUDE_DIR)
  message(FATAL_ERROR "RapidJSON was not found: install rapidjson-dev")
endif()
# qhull brings pkg-config files since 2020 only; the reentrant library is there since 2015.
find_path(CPROX_QHULL_INCLUDE_DIR libqhull_r/qhull_ra.h)
find_library(CPROX_QHULL_LIBRARY qhull_r)
mark_as_advanced(CPROX_QHULL_INCLUDE_DIR CPROX_QHULL_LIBRARY)
if(NOT CPROX_QHULL_INCLUDE_DIR OR NOT CPROX_QHULL_LIBRARY)
  message(FATAL_ERROR "qhull was not found: install libqhull-dev")
endif()
