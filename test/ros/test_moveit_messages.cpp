/* SPDX-License-Identifier: BSD-3-Clause */
/* The wire types of moveit_msgs against bytes that moveit_msgs's own classes wrote (test/data/moveit). That each field
 * stands where it belongs is seen by test_planning_scene, which reads the same bytes, and by planning_scene.py, whose
 * classes are made of the definitions: with another md5 sum nothing would connect. */
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "moveit_data.h"

namespace curve_proximity {
namespace {

using test::Bytes;
using test::read;
using test::recorded;

template <class Message>
Bytes written(const Message &message) {
  Bytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

/* Read and written again it is the same bytes; a message that is cut anywhere is refused. */
template <class Message>
void expectSame(const std::string &name) {
  SCOPED_TRACE(name);
  const Bytes bytes = recorded(name);
  EXPECT_EQ(written(read<Message>(bytes)), bytes);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(read<Message>(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size))),
                 ros::serialization::StreamOverrunException)
        << size;
}

TEST(MoveitMessages, recorded_bytes_are_read_and_written_as_they_are) {
  expectSame<moveit::PlanningScene>("planning_scene_full");
  expectSame<moveit::PlanningScene>("planning_scene_diff");
  expectSame<moveit::RobotTrajectory>("robot_trajectory");
  expectSame<moveit::DisplayTrajectory>("display_trajectory");
  expectSame<moveit::ContactInformation>("contact_information");
  expectSame<moveit::GetPlanningSceneRequest>("get_planning_scene_request");
  expectSame<moveit::GetPlanningSceneResponse>("get_planning_scene_response");
}

/* Each four bytes of a message as the count of something: no more is allocated than the bytes can hold. */
TEST(MoveitMessages, counts_that_lie_take_no_memory) {
  for (const std::uint32_t lie : {0xffffffffu, 0x7fffffffu, 0x10000000u, 1000000u}) {
    const Bytes bytes = recorded("planning_scene_full");
    for (std::size_t at = 0; at + sizeof lie <= bytes.size(); ++at) {
      Bytes wrong = bytes;
      std::memcpy(wrong.data() + at, &lie, sizeof lie);
      try {
        const auto scene = read<moveit::PlanningScene>(wrong);
        EXPECT_LE(scene.world.collision_objects.capacity(), bytes.size());
      } catch (const ros::serialization::StreamOverrunException &) { // as it should be, where it is a count
      }
    }
  }
}

} // namespace
} // namespace curve_proximity
