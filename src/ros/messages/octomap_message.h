/* SPDX-License-Identifier: BSD-3-Clause */
/** octomap_msgs/Octomap: generated of the definitions in src/ros/foreign. */
#ifndef CURVE_PROXIMITY_ROS_OCTOMAP_MESSAGE_H
#define CURVE_PROXIMITY_ROS_OCTOMAP_MESSAGE_H

#include <foreign/octomap_msgs/Octomap.h>

namespace curve_proximity {

using OctomapMessage = octomap_msgs::Octomap;

} // namespace curve_proximity
#endif
