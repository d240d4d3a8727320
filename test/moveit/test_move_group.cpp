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

#include <atomic>
#include <map>
#include <thread>

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

  moveit_msgs::CollisionObject plateInTheWay() const {
    const Eigen::Vector3d fingers = ready_.getGlobalLinkTransform("panda_leftfinger").translation();
    return plateAt("plate", fingers.x() + WAY / 2.0, 0.0, fingers.z() - 0.03);
  }

  /* One change: a name, and the plate there or not there. */
  void changeScene(const std::string &name, bool has_plate) {
    moveit_msgs::ApplyPlanningScene applied;
    applied.request.scene.is_diff = applied.request.scene.robot_state.is_diff = true;
    applied.request.scene.name = name;
    moveit_msgs::CollisionObject plate = plateInTheWay();
    if (!has_plate) plate.operation = moveit_msgs::CollisionObject::REMOVE;
    applied.request.scene.world.collision_objects = {plate};
    call("apply_planning_scene", applied);
    EXPECT_TRUE(applied.response.success);
  }

  /* A plate beside the path, as nothing is proven against no object, and perhaps one between the fingers' first place and
   * their last. */
  void setPlates(bool one_in_the_way) {
    moveit_msgs::ApplyPlanningScene applied;
    applied.request.scene.is_diff = applied.request.scene.robot_state.is_diff = true;
    const moveit_msgs::CollisionObject plate = plateInTheWay();
    const geometry_msgs::Point &at = plate.primitive_poses[0].position;
    std::vector<moveit_msgs::CollisionObject> &objects = applied.request.scene.world.collision_objects;
    objects = {plateAt("shelf", at.x, 0.8, at.z)};
    if (one_in_the_way) objects.push_back(plate);
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

TEST_F(MoveGroup, certifies_again_in_the_same_scene_where_nothing_has_changed) {
  const moveit_msgs::RobotTrajectory path = cartesianPath();
  ros::Time before, stamp = certify(path).scene_stamp;
  for (int i = 0; i < 50 && stamp != before; ++i) { // the robot's state may still come in
    before = stamp;
    stamp = certify(path).scene_stamp;
  }
  EXPECT_EQ(stamp, before);
  changeScene("changed", true);
  EXPECT_NE(certify(path).scene_stamp, before);
}

/* While another client puts the plate there and takes it away, and names the scene anew each time. */
TEST_F(MoveGroup, certifies_in_the_scene_that_the_answer_names) {
  const moveit_msgs::RobotTrajectory path = cartesianPath();
  changeScene("blocked", true);
  std::atomic<bool> is_over{false};
  std::thread other([&] {
    for (bool is_free = true; !is_over; is_free = !is_free) changeScene(is_free ? "free" : "blocked", !is_free);
  });
  std::map<std::string, int> answers;
  std::map<ros::Time, std::string> scenes;
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(60.0);
  while ((answers["free"] < 10 || answers["blocked"] < 10) && ros::WallTime::now() < end) {
    const curve_proximity::CertifyPath::Response res = certify(path);
    EXPECT_EQ(res.certified, res.scene == "free") << res.scene << ": " << res.message;
    EXPECT_EQ(scenes.emplace(res.scene_stamp, res.scene).first->second, res.scene) << "the same stamp";
    ++answers[res.scene];
  }
  is_over = true;
  other.join();
  EXPECT_GE(answers["free"], 10);
  EXPECT_GE(answers["blocked"], 10);
}

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_move_group");
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}
