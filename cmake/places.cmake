# SPDX-License-Identifier: BSD-3-Clause
# Where things stand, in the build and below the prefix of an installation.
if(CPROX_ROS)
  set(CPROX_LIB_DIR ${CATKIN_PACKAGE_LIB_DESTINATION})
  set(CPROX_PROGRAM_DIR ${CATKIN_PACKAGE_BIN_DESTINATION})
  set(CPROX_PYTHON_DIR ${CATKIN_GLOBAL_PYTHON_DESTINATION})
  set(CPROX_BUILT ${CATKIN_DEVEL_PREFIX})
else()
  include(GNUInstallDirs)
  set(CPROX_LIB_DIR ${CMAKE_INSTALL_LIBDIR})
  set(CPROX_PROGRAM_DIR ${CPROX_LIB_DIR}/${PROJECT_NAME})
  set(CPROX_PYTHON_DIR ${CPROX_LIB_DIR}/python3/dist-packages)
  set(CPROX_BUILT ${PROJECT_BINARY_DIR}/built)
endif()
