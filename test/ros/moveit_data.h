/* SPDX-License-Identifier: BSD-3-Clause */
/* The messages of test/data/moveit, which moveit_msgs's own classes wrote. */
#ifndef CURVE_PROXIMITY_TEST_ROS_MOVEIT_DATA_H
#define CURVE_PROXIMITY_TEST_ROS_MOVEIT_DATA_H

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "moveit/moveit_messages.h"
#include "transport/checked_stream.h"

namespace curve_proximity {
namespace test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes recorded(const std::string &name) {
  std::ifstream file(std::string(CURVE_PROXIMITY_MOVEIT_DATA) + "/" + name + ".bin", std::ios::binary);
  EXPECT_TRUE(file.good()) << name;
  return Bytes(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

/* Throws ros::serialization::StreamOverrunException. */
template <class Message>
Message read(Bytes bytes) {
  Message message;
  CheckedStream stream(bytes.data(), bytes.size());
  stream.next(message);
  return message;
}

} // namespace test
} // namespace curve_proximity
#endif
