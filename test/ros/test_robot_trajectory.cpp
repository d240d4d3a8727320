/* SPDX-License-Identifier: BSD-3-Clause */
/* moveit_msgs/RobotTrajectory and DisplayTrajectory as what the queries take. */
#include "moveit/robot_trajectory.h"

#include <gtest/gtest.h>

#include <limits>

namespace curve_proximity {
namespace {

const char *CART = R"(<robot name="cart">
  <link name="deck"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="mast"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="lift" type="prismatic"><parent link="deck"/><child link="mast"/><origin xyz="0 0 2"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="9" effort="1" velocity="1"/></joint>
</robot>)";

trajectory_msgs::JointTrajectory lift(std::initializer_list<double> heights, const std::string &joint = "lift") {
  trajectory_msgs::JointTrajectory out;
  out.joint_names = {joint};
  for (const double height : heights) {
    out.points.emplace_back();
    out.points.back().positions = {height};
    out.points.back().time_from_start = ros::Duration(static_cast<double>(out.points.size() - 1));
  }
  return out;
}

trajectory_msgs::MultiDOFJointTrajectory drive(std::initializer_list<double> ways,
                                               const std::string &joint = "wheels") {
  trajectory_msgs::MultiDOFJointTrajectory out;
  out.joint_names = {joint};
  for (const double x : ways) {
    geometry_msgs::Transform transform;
    transform.translation.x = x;
    transform.rotation.w = 1.0;
    out.points.emplace_back();
    out.points.back().transforms = {transform};
    out.points.back().time_from_start = ros::Duration(static_cast<double>(out.points.size() - 1));
  }
  return out;
}

struct Cart : ::testing::Test {
  const Scene scene{Robot::fromUrdf(CART)};
  const SnapshotPtr snapshot = scene.snapshot();
  Srdf srdf;

  Cart() {
    srdf.virtual_joints = {{"wheels", "planar", "odom", "deck"}};
  }

  template <class Message>
  void expectRefused(const Message &message, const std::string &word) const {
    try {
      toMotions(message, *snapshot, srdf);
      FAIL() << "not refused";
    } catch (const Error &error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
};

using Names = std::vector<std::string>;
using Values = std::vector<double>;

TEST_F(Cart, both_parts_become_one_trajectory) {
  moveit::RobotTrajectory message;
  message.joint_trajectory = lift({0, 1});
  message.joint_trajectory.points[1].velocities = {0.0};
  message.multi_dof_joint_trajectory = drive({5, 6});
  const RobotMotions motions = toMotions(message, *snapshot, srdf);
  ASSERT_EQ(motions.trajectories.size(), 1u);
  EXPECT_EQ(motions.trajectories[0].joint_names, (Names{"lift", "wheels/x", "wheels/y", "wheels/theta"}));
  EXPECT_EQ(motions.trajectories[0].points[1].positions, (Values{1, 6, 0, 0}));
  EXPECT_TRUE(motions.trajectories[0].points[1].velocities.empty());
  ASSERT_EQ(motions.remarks.size(), 1u);
  EXPECT_NE(motions.remarks[0].find("velocities are not used"), std::string::npos);
  EXPECT_EQ(motions.coverage.status(), "partial"); // the joints go another way than the message says
  EXPECT_FALSE(motions.coverage.provesContact());

  message.joint_trajectory = {};
  EXPECT_EQ(toMotions(message, *snapshot, srdf).trajectories[0].joint_names.size(), 3u);
}

TEST_F(Cart, parts_that_do_not_fit_are_refused) {
  moveit::RobotTrajectory message;
  expectRefused(message, "names no joints");
  message.joint_trajectory = lift({0, 1, 2});
  message.multi_dof_joint_trajectory = drive({5, 6});
  expectRefused(message, "3 points");
  message.joint_trajectory = lift({0, 1});
  message.joint_trajectory.points[1].time_from_start = ros::Duration(1.5);
  expectRefused(message, "times");
  message.joint_trajectory = lift({0, 1});
  message.joint_trajectory.points[0].positions.clear();
  expectRefused(message, "0 positions");
  message.multi_dof_joint_trajectory.points[0].transforms.clear();
  expectRefused(message, "0 transforms");
}

TEST_F(Cart, joints_that_the_robot_does_not_have_are_left_out) {
  moveit::RobotTrajectory message;
  message.joint_trajectory = lift({0, 1});
  message.joint_trajectory.joint_names = {"elbow", "lift"};
  message.joint_trajectory.points[0].positions = {7, 0};
  message.joint_trajectory.points[1].positions = {8, 1};
  message.multi_dof_joint_trajectory = drive({5, 6}, "wings");
  const RobotMotions motions = toMotions(message, *snapshot, srdf);
  EXPECT_EQ(motions.trajectories[0].joint_names, Names{"lift"});
  EXPECT_EQ(motions.trajectories[0].points[1].positions, Values{1});
  ASSERT_EQ(motions.remarks.size(), 1u);
  EXPECT_NE(motions.remarks[0].find("'elbow', 'wings'"), std::string::npos) << motions.remarks[0];
  message.joint_trajectory = lift({0, 1}, "elbow");
  expectRefused(message, "'elbow', 'wings'");
}

TEST_F(Cart, each_trajectory_begins_where_the_one_before_has_ended) {
  moveit::DisplayTrajectory message;
  expectRefused(message, "no trajectory");
  message.model_id = "barrow";
  message.trajectory.resize(2);
  message.trajectory[0].multi_dof_joint_trajectory = drive({0, 4});
  message.trajectory[1].joint_trajectory = lift({2, 3});
  for (auto &point : message.trajectory[1].joint_trajectory.points) point.time_from_start += ros::Duration(1.0);
  moveit::RobotState &start = message.trajectory_start;
  start.joint_state.name = {"lift", "elbow"};
  start.joint_state.position = {0.5, 0.0};
  const RobotMotions motions = toMotions(message, *snapshot, srdf);
  ASSERT_EQ(motions.trajectories.size(), 2u);
  EXPECT_EQ(motions.start.name, Names{"lift"});
  const trajectory_msgs::JointTrajectory &second = motions.trajectories[1];
  EXPECT_EQ(second.joint_names, (Names{"lift", "wheels/theta", "wheels/x", "wheels/y"}));
  ASSERT_EQ(second.points.size(), 3u);
  EXPECT_EQ(second.points[0].positions, (Values{0.5, 0, 4, 0})); // the way to its first point
  EXPECT_EQ(second.points[1].positions, (Values{2, 0, 4, 0}));
  EXPECT_EQ(motions.remarks.size(), 2u); // the model's name, and the elbow
  EXPECT_EQ(motions.coverage.status(), "unknown");
  message.model_id = snapshot->robot()->name();
  EXPECT_TRUE(toMotions(message, *snapshot, srdf).coverage.complete());

  // the base where the start state has it
  message.trajectory.erase(message.trajectory.begin());
  start.multi_dof_joint_state.joint_names = {"wheels"};
  start.multi_dof_joint_state.transforms = drive({9}).points[0].transforms;
  EXPECT_EQ(toMotions(message, *snapshot, srdf).trajectories[0].points[0].positions, (Values{2, 0, 9, 0}));

  // what is carried there and not in the scene can only be missing
  start.attached_collision_objects.resize(1);
  start.attached_collision_objects[0].object.id = "pen";
  EXPECT_EQ(toMotions(message, *snapshot, srdf).coverage.status(), "partial");
  EXPECT_TRUE(toMotions(message, *snapshot, srdf).coverage.provesContact());
  start.joint_state.position.pop_back();
  expectRefused(message, "2 joints have 1 positions");
}

TEST_F(Cart, contacts_are_rows_that_are_not_clear) {
  Proximity row;
  row.a = "mast";
  row.b = "wall";
  row.upper = 1e-7;
  row.witness_a.x = 1.0;
  row.witness_b.x = 2.0;
  ASSERT_TRUE(toContact(row, 1e-6, *snapshot));
  const moveit::ContactInformation contact = *toContact(row, 1e-6, *snapshot);
  EXPECT_EQ(contact.position.x, 1.5);
  EXPECT_EQ(contact.depth, -1e-7);
  EXPECT_EQ(contact.body_type_1, moveit::ContactInformation::ROBOT_LINK);
  EXPECT_EQ(contact.body_type_2, moveit::ContactInformation::WORLD_OBJECT);
  row.lower = row.upper = 0.1;
  EXPECT_FALSE(toContact(row, 1e-6, *snapshot));
  row.verdict = Proximity::VERDICT_CLEAR;
  EXPECT_FALSE(toContact(row, 1e-6, *snapshot));
  row.verdict = Proximity::VERDICT_VIOLATED;
  EXPECT_EQ(toContact(row, 1e-6, *snapshot)->contact_body_2, "wall");

  // What is not known is no contact, and not clear: the second body is the word for it.
  row.verdict = Proximity::VERDICT_UNDECIDED;
  row.status = Proximity::STATUS_STALE;
  row.lower = 0.0;
  EXPECT_EQ(toContact(row, 1e-6, *snapshot)->contact_body_1, "mast");
  EXPECT_EQ(toContact(row, 1e-6, *snapshot)->contact_body_2, "<stale>");
  EXPECT_EQ(toContact(row, 1e-6, *snapshot)->depth, 0.0);
  row.status = Proximity::STATUS_OK;
  EXPECT_EQ(toContact(row, 1e-6, *snapshot)->contact_body_2, "<undecided>");
  row.verdict = "";
  row.status = Proximity::STATUS_INVALID;
  row.lower = row.upper = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(toContact(row, 1e-6, *snapshot)->contact_body_2, "<invalid>");
}

} // namespace
} // namespace curve_proximity
