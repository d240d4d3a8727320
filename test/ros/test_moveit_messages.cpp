/* SPDX-License-Identifier: BSD-3-Clause */
/* The wire types of moveit_msgs against bytes that moveit_msgs's own classes wrote (test/data/moveit). */
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

/* What another layout of the same size would leave unnoticed. */
TEST(MoveitMessages, fields_stand_where_they_belong) {
  const auto scene = read<moveit::PlanningScene>(recorded("planning_scene_full"));
  EXPECT_EQ(scene.name, "(noname)");
  EXPECT_EQ(scene.robot_model_name, "arm");
  EXPECT_EQ(scene.is_diff, 0);
  EXPECT_EQ(scene.robot_state.joint_state.position, std::vector<double>{0.25});
  EXPECT_EQ(scene.robot_state.multi_dof_joint_state.joint_names, std::vector<std::string>{"base_joint"});
  ASSERT_EQ(scene.robot_state.attached_collision_objects.size(), 1u);
  const moveit::AttachedCollisionObject &tool = scene.robot_state.attached_collision_objects[0];
  EXPECT_EQ(tool.touch_links, (std::vector<std::string>{"slider", "base"}));
  EXPECT_EQ(tool.weight, 1.5);
  EXPECT_EQ(tool.object.pose.position.z, 0.2);
  EXPECT_EQ(tool.object.subframe_names, std::vector<std::string>{"tip"});
  ASSERT_EQ(scene.fixed_frame_transforms.size(), 2u);
  EXPECT_EQ(scene.fixed_frame_transforms[1].child_frame_id, "shelf");
  EXPECT_EQ(scene.allowed_collision_matrix.entry_values.at(0).enabled, (std::vector<std::uint8_t>{0, 0, 1, 0}));
  EXPECT_EQ(scene.allowed_collision_matrix.default_entry_values, (std::vector<std::uint8_t>{0, 1}));
  EXPECT_EQ(scene.link_padding.at(0).padding, 0.01);
  EXPECT_EQ(scene.link_scale.at(0).scale, 1.5);
  EXPECT_EQ(scene.object_colors.at(0).color.g, 0.5f);
  ASSERT_EQ(scene.world.collision_objects.size(), 3u);
  const moveit::CollisionObject &table = scene.world.collision_objects[0];
  EXPECT_EQ(table.type.key, "table");
  EXPECT_EQ(table.primitives.at(1).dimensions.at(0), 0.4);
  EXPECT_EQ(table.meshes.at(0).vertices.at(3).z, 1.1);
  EXPECT_EQ(table.subframe_poses.at(1).orientation.w, 0.8);
  EXPECT_EQ(scene.world.collision_objects[1].planes.at(0).coef[2], 1.0);
  EXPECT_EQ(scene.world.octomap.origin.position.y, 5.0);
  EXPECT_EQ(scene.world.octomap.octomap.resolution, 0.5);

  const auto diff = read<moveit::PlanningScene>(recorded("planning_scene_diff"));
  EXPECT_EQ(diff.is_diff, 1);
  EXPECT_EQ(diff.robot_state.is_diff, 1);
  EXPECT_EQ(diff.world.collision_objects.at(1).operation, moveit::CollisionObject::MOVE);

  const auto shown = read<moveit::DisplayTrajectory>(recorded("display_trajectory"));
  EXPECT_EQ(shown.trajectory.at(1).multi_dof_joint_trajectory.points.at(1).transforms.at(0).translation.x, 1.0);
  EXPECT_EQ(shown.trajectory_start.joint_state.name, std::vector<std::string>{"turn"});

  const auto contact = read<moveit::ContactInformation>(recorded("contact_information"));
  EXPECT_EQ(contact.contact_body_2, "table");
  EXPECT_EQ(contact.body_type_2, moveit::ContactInformation::WORLD_OBJECT);
  EXPECT_EQ(read<moveit::GetPlanningSceneRequest>(recorded("get_planning_scene_request")).components,
            moveit::GetPlanningSceneRequest::ALL);
}

/* The sums of moveit_msgs 0.11, as catkin's generators have published them. */
TEST(MoveitMessages, md5_sums_are_those_of_the_published_definitions) {
  using ros::message_traits::md5sum;
  EXPECT_STREQ(md5sum<moveit::PlanningScene>(), "acfc50bcfd6c7b978066bfa7c786002c");
  EXPECT_STREQ(md5sum<moveit::RobotTrajectory>(), "dfa9556423d709a3729bcef664bddf67");
  EXPECT_STREQ(md5sum<moveit::DisplayTrajectory>(), "41936b74e168ba754279ae683ce3f121");
  EXPECT_STREQ(md5sum<moveit::ContactInformation>(), "116228ca08b0c286ec5ca32a50fdc17b");
  EXPECT_STREQ(md5sum<moveit::GetPlanningSceneRequest>(), "d81da6c0e5e015646a4efe344f33d7dc");
  EXPECT_STREQ(moveit::GET_PLANNING_SCENE_MD5, "65cf69d3e7a0342e16374024d4eeef65");
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
