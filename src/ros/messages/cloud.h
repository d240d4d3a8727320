/* SPDX-License-Identifier: BSD-3-Clause */
/** From sensor_msgs/PointCloud2 to points. */
#ifndef CURVE_PROXIMITY_ROS_CLOUD_H
#define CURVE_PROXIMITY_ROS_CLOUD_H

#include <sensor_msgs/PointCloud2.h>

#include <cstddef>
#include <curve_proximity/core.hpp>

namespace curve_proximity {

struct Cloud {
  Eigen::Matrix3Xd points;  /**< [m] in the cloud's frame */
  std::size_t left_out = 0; /**< points that were not finite: where the sensor measured nothing */
};

/** The points x, y, z, each float32 or float64, of either byte order. A cloud of width or height 0 has none.
 *  Throws Error for fields that are missing or of another type, and for steps that do not fit the data. */
Cloud toCloud(const sensor_msgs::PointCloud2 &message);

} // namespace curve_proximity
#endif
