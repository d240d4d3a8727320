# SPDX-License-Identifier: BSD-3-Clause
# What the ROS side needs beside the scene's libraries.

find_package(catkin REQUIRED COMPONENTS
  actionlib actionlib_msgs diagnostic_msgs diagnostic_updater dynamic_reconfigure geometric_shapes geometry_msgs message_generation
  nav_msgs nodelet pluginlib roscpp roslib sensor_msgs shape_msgs std_msgs tf2 tf2_ros trajectory_msgs
  visualization_msgs)
pkg_check_modules(PC_JSON REQUIRED nlohmann_json)
