# SPDX-License-Identifier: BSD-3-Clause
# What rooms link. Foreign headers are SYSTEM: their warnings are not ours. None of these targets is exported, so their
# absolute paths stay here.
#catkin_lint: ignore external_interface_path
add_library(cprox_catkin INTERFACE)
target_include_directories(cprox_catkin SYSTEM INTERFACE ${catkin_INCLUDE_DIRS})
target_link_libraries(cprox_catkin INTERFACE ${catkin_LIBRARIES})
add_library(cprox_fcl INTERFACE)
target_include_directories(cprox_fcl SYSTEM INTERFACE ${CPROX_FCL_INCLUDE_DIRS} ${EIGEN3_INCLUDE_DIRS})
target_link_libraries(cprox_fcl INTERFACE ${CPROX_FCL_LIBRARIES})
add_library(cprox_ccd INTERFACE)
target_include_directories(cprox_ccd SYSTEM INTERFACE ${CPROX_CCD_INCLUDE_DIRS})
target_link_libraries(cprox_ccd INTERFACE ${CPROX_CCD_LIBRARIES})
add_library(cprox_yaml INTERFACE)
target_include_directories(cprox_yaml SYSTEM INTERFACE ${CPROX_YAML_INCLUDE_DIRS})
target_link_libraries(cprox_yaml INTERFACE ${CPROX_YAML_LIBRARIES})
add_library(cprox_urdfdom INTERFACE)
target_include_directories(cprox_urdfdom SYSTEM INTERFACE ${PC_URDFDOM_INCLUDEDIR} ${PC_URDFDOM_INCLUDE_DIRS})
target_link_libraries(cprox_urdfdom INTERFACE ${PC_URDFDOM_LINK_LIBRARIES})
add_library(cprox_tinyxml2 INTERFACE)
target_include_directories(cprox_tinyxml2 SYSTEM INTERFACE ${PC_TINYXML2_INCLUDEDIR} ${PC_TINYXML2_INCLUDE_DIRS})
target_link_libraries(cprox_tinyxml2 INTERFACE ${PC_TINYXML2_LINK_LIBRARIES})
