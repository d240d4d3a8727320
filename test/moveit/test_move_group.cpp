/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions of a running move_group that no pipeline sees: a Cartesian path, and what is executed. */
#include <actionlib/client/simple_action_client.h>
#include <gtest/gtest.h>
#include <moveit/robot_model_loader/robot_model_loader.h>
#include <moveit/robot_state/conversions.h>
#include <moveit_msgs/ApplyPlanningScene.h>
#include <moveit_msgs/ExecuteTrajectoryAction.h>
#include <moveit_msgs/GetCartesianPath.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_eigen/tf2_eigen.h>

#include <curve_proximity/CertifyPath.h>
#include <curve_proximity/GetScene.h>

namespace {

constexpr double WAY = 0.25; /* [m] of the Cartesian path, forward */

class MoveGroup : public testing::Test {
 protected:
  MoveGroup()
      : model_(robot_model_loader::RobotModelLoader("robot_description", false).getModel()),
        ready_(model_),
        joint_states_(node_.advertise<sensor_msgs::JointState>("/joint_states", 1, true)),
        execute_("execute_trajectory", false) {
    ready_.setToDefaultValues();
    ready_.setToDefaultValues(model_->getJointModelGroup("panda_arm"), "ready");
    ready_.update();
    moveit_msgs::RobotState state;
    moveit::core::robotStateToRobotStateMsg(ready_, state);
    state.joint_state.header.stamp = ros::Time::now();
    joint_states_.publish(state.joint_state);
  }

  template <typename Service>
  void call(const std::string &name, Service &service) {
    ros::ServiceClient client = node_.serviceClient<Service>(name);
    ASSERT_TRUE(client.waitForExistence(ros::Duration(60.0))) << name;
    ASSERT_TRUE(client.call(service)) << name;
  }

  static moveit_msgs::CollisionObject plateAt(const std::string &id, double x, double y, double z) {
    moveit_msgs::CollisionObject out;
    out.header.frame_id = "panda_link0";
    out.id = id;
    out.operation = moveit_msgs::CollisionObject::ADD;
    shape_msgs::SolidPrimitive box;
    box.type = shape_msgs::SolidPrimitive::BOX;
    box.dimensions = {0.005, 0.1, 0.04};
    geometry_msgs::Pose pose;
    pose.position.x = x;
    pose.position.y = y;
    pose.position.z = z;
    pose.orientation.w = 1.0;
    out.primitives = {box};
    out.primitive_poses = {pose};
    return out;
  }

  /* A plate beside the path, as nothing is proven against no object, and perhaps one between the fingers' first place and
   * their last. */
  void setPlates(bool one_in_the_way) {
    moveit_msgs::ApplyPlanningScene applied;
    applied.request.scene.is_diff = applied.request.scene.robot_state.is_diff = true;
    const Eigen::Vector3d fingers = ready_.getGlobalLinkTransform("panda_leftfinger").translation();
    const double x = fingers.x() + WAY / 2.0, z = fingers.z() - 0.03;
    std::vector<moveit_msgs::CollisionObject> &objects = applied.request.scene.world.collision_objects;
    objects = {plateAt("shelf", x, 0.8, z)};
    if (one_in_the_way) objects.push_back(plateAt("plate", x, 0.0, z));
    call("apply_planning_scene", applied);
    ASSERT_TRUE(applied.response.success);
    curve_proximity::GetScene known;
    for (int i = 0; i < 200; ++i) { // the server follows
      call("/curve_proximity/get_scene", known);
      if (known.response.success && known.response.objects.size() == objects.size()) return;
      ros::WallDuration(0.1).sleep();
    }
    FAIL() << "the server does not follow move_group's scene";
  }

  /* The hand goes straight forward, whatever stands there. */
  moveit_msgs::RobotTrajectory cartesianPath() {
    moveit_msgs::GetCartesianPath path;
    path.request.header.frame_id = "panda_link0";
    path.request.group_name = "panda_arm";
    path.request.link_name = "panda_link8";
    moveit::core::robotStateToRobotStateMsg(ready_, path.request.start_state);
    Eigen::Isometry3d goal = ready_.getGlobalLinkTransform("panda_link8");
    goal.translation().x() += WAY;
    path.request.waypoints = {tf2::toMsg(goal)};
    path.request.max_step = 2.0 * WAY;
    path.request.avoid_collisions = false;
    call("compute_cartesian_path", path);
    EXPECT_EQ(path.response.fraction, 1.0);
    EXPECT_GE(path.response.solution.joint_trajectory.points.size(), 2u);
    return path.response.solution;
  }

  curve_proximity::CertifyPath::Response certify(const moveit_msgs::RobotTrajectory &trajectory) {
    curve_proximity::CertifyPath asked;
    asked.request.joint_trajectory = trajectory.joint_trajectory;
    call("certify_path", asked);
    return asked.response;
  }

  int execute(const moveit_msgs::RobotTrajectory &trajectory) {
    if (!execute_.waitForServer(ros::Duration(60.0))) return 0;
    moveit_msgs::ExecuteTrajectoryGoal goal;
    goal.trajectory = trajectory;
    execute_.sendGoalAndWait(goal, ros::Duration(60.0));
    return execute_.getResult() ? execute_.getResult()->error_code.val : 0;
  }

  ros::NodeHandle node_;
  moveit::core::RobotModelPtr model_;
  moveit::core::RobotState ready_;
  ros::Publisher joint_states_;
  actionlib::SimpleActionClient<moveit_msgs::ExecuteTrajectoryAction> execute_;
};

} // namespace

TEST_F(MoveGroup, certifies_a_cartesian_path_and_the_gate_lets_it_pass) {
  setPlates(false);
  const moveit_msgs::RobotTrajectory path = cartesianPath();
  const curve_proximity::CertifyPath::Response res = certify(path);
  EXPECT_TRUE(res.certified) << res.message;
  int executed = 0; // the server may not know the whole scene yet
  for (int i = 0; i < 60 && executed != moveit_msgs::MoveItErrorCodes::SUCCESS; ++i) {
    executed = execute(path);
    ros::WallDuration(0.25).sleep();
  }
  EXPECT_EQ(executed, moveit_msgs::MoveItErrorCodes::SUCCESS);
}

TEST_F(MoveGroup, certifies_no_path_through_a_plate_and_the_gate_refuses_it) {
  setPlates(true);
  const moveit_msgs::RobotTrajectory path = cartesianPath();
  const curve_proximity::CertifyPath::Response res = certify(path);
  EXPECT_FALSE(res.certified);
  ASSERT_EQ(res.violations.size(), 1u);
  EXPECT_EQ(res.violations[0].summary.b, "plate");
  EXPECT_EQ(execute(path), moveit_msgs::MoveItErrorCodes::CONTROL_FAILED);
}

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_move_group");
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}
