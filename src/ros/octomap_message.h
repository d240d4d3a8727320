/* SPDX-License-Identifier: BSD-3-Clause */
/** octomap_msgs/Octomap as roscpp receives it, by its published definition: octomap_msgs itself need not be installed.
 */
#ifndef CURVE_PROXIMITY_ROS_OCTOMAP_MESSAGE_H
#define CURVE_PROXIMITY_ROS_OCTOMAP_MESSAGE_H

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <string>
#include <vector>

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

namespace ros {
namespace message_traits {

template <>
struct IsMessage<curve_proximity::OctomapMessage> : TrueType {};
template <>
struct IsMessage<const curve_proximity::OctomapMessage> : TrueType {};
template <>
struct HasHeader<curve_proximity::OctomapMessage> : TrueType {};

template <>
struct MD5Sum<curve_proximity::OctomapMessage> {
  static const char *value() {
    return "9a45536b45c5e409cd49f04bb2d9999f";
  }
  static const char *value(const curve_proximity::OctomapMessage &) {
    return value();
  }
};

template <>
struct DataType<curve_proximity::OctomapMessage> {
  static const char *value() {
    return "octomap_msgs/Octomap";
  }
  static const char *value(const curve_proximity::OctomapMessage &) {
    return value();
  }
};

template <>
struct Definition<curve_proximity::OctomapMessage> {
  static const char *value() {
    return "Header header\nbool binary\nstring id\nfloat64 resolution\nint8[] data\n";
  }
  static const char *value(const curve_proximity::OctomapMessage &) {
    return value();
  }
};

} // namespace message_traits

namespace serialization {

template <>
struct Serializer<curve_proximity::OctomapMessage> {
  template <typename Stream, typename Message>
  static void allInOne(Stream &stream, Message message) {
    stream.next(message.header);
    stream.next(message.binary);
    stream.next(message.id);
    stream.next(message.resolution);
    stream.next(message.data);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

} // namespace serialization
} // namespace ros
#endif
