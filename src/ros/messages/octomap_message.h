/* SPDX-License-Identifier: BSD-3-Clause */
/** octomap_msgs/Octomap as roscpp receives it, by its published definition: octomap_msgs itself need not be installed.
 */
#ifndef CURVE_PROXIMITY_ROS_OCTOMAP_MESSAGE_H
#define CURVE_PROXIMITY_ROS_OCTOMAP_MESSAGE_H

#include <std_msgs/Header.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "messages/foreign_message.h"

namespace curve_proximity {

struct OctomapMessage {
  std_msgs::Header header;
  std::uint8_t binary = 0;
  std::string id;
  double resolution = 0.0;
  std::vector<std::int8_t> data;

  using Ptr = boost::shared_ptr<OctomapMessage>;
  using ConstPtr = boost::shared_ptr<const OctomapMessage>;
};

} // namespace curve_proximity

CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::OctomapMessage, header, binary, id, resolution, data)
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::OctomapMessage, "octomap_msgs/Octomap",
                               "9a45536b45c5e409cd49f04bb2d9999f",
                               "Header header\nbool binary\nstring id\nfloat64 resolution\nint8[] data\n")
namespace ros::message_traits {
template <>
struct HasHeader<curve_proximity::OctomapMessage> : TrueType {};
} // namespace ros::message_traits
#endif
