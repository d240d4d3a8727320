/* SPDX-License-Identifier: BSD-3-Clause */
/* The classes made of src/ros/foreign against the published md5 sums, and against bytes that moveit_msgs's own classes
 * wrote (test/data/moveit). That each field stands where it belongs is seen by test_planning_scene, which reads the same
 * bytes. */
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "messages/octomap_message.h"
#include "moveit/follow_joint_trajectory.h"
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

TEST(MoveitMessages, definitions_are_the_published_ones) {
  using ros::message_traits::md5sum;
  EXPECT_STREQ(md5sum<moveit::PlanningScene>(), "acfc50bcfd6c7b978066bfa7c786002c");
  EXPECT_STREQ(md5sum<moveit::RobotTrajectory>(), "dfa9556423d709a3729bcef664bddf67");
  EXPECT_STREQ(md5sum<moveit::DisplayTrajectory>(), "41936b74e168ba754279ae683ce3f121");
  EXPECT_STREQ(md5sum<moveit::ContactInformation>(), "116228ca08b0c286ec5ca32a50fdc17b");
  EXPECT_STREQ(ros::service_traits::md5sum<moveit::GetPlanningScene>(), "65cf69d3e7a0342e16374024d4eeef65");
  EXPECT_STREQ(md5sum<control::FollowJointTrajectoryAction>(), "bc4f9b743838566551c0390c65f1a248");
  EXPECT_STREQ(md5sum<OctomapMessage>(), "9a45536b45c5e409cd49f04bb2d9999f");
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
