# SPDX-License-Identifier: BSD-3-Clause
# What the ROS side needs beside the scene's libraries.

find_package(catkin REQUIRED COMPONENTS
  actionlib actionlib_msgs diagnostic_msgs diagnostic_updater dynamic_reconfigure geometric_shapes geometry_msgs message_generation
  nav_msgs nodelet pluginlib roscpp roslib sensor_msgs shape_msgs std_msgs tf2 tf2_eigen tf2_ros trajectory_msgs urdf
  visualization_msgs)
# libccd: by pkg-config, as an absolute library file.
pkg_check_modules(PC_CCD REQUIRED ccd)
set(CPROX_CCD_LIBRARIES ${PC_CCD_LINK_LIBRARIES})
set(CPROX_CCD_INCLUDE_DIRS ${PC_CCD_INCLUDEDIR} ${PC_CCD_INCLUDE_DIRS})
pkg_check_modules(PC_JSON REQUIRED nlohmann_json)
