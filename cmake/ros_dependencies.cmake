# SPDX-License-Identifier: BSD-3-Clause
# What the ROS side needs beside the scene's libraries.

find_package(catkin REQUIRED COMPONENTS
  actionlib actionlib_msgs diagnostic_msgs diagnostic_updater dynamic_reconfigure geometric_shapes geometry_msgs message_generation
  nav_msgs nodelet pluginlib roscpp roslib sensor_msgs shape_msgs std_msgs tf2 tf2_ros trajectory_msgs
  visualization_msgs)

# MoveIt, where it is there: the plugins of src/moveit.
find_package(moveit_core QUIET)
if(moveit_core_FOUND)
  message(STATUS "MoveIt ${moveit_core_VERSION}: adapter and collision plugin are built")
else()
  message(STATUS "MoveIt not found: adapter and collision plugin are not built")
endif()
