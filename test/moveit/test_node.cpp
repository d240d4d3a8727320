/* SPDX-License-Identifier: BSD-3-Clause */
/* Our node answers about scenes that MoveIt's PlanningScene has written, full and diff, as MoveIt's FCL detector does.
 */
#include <curve_proximity/Distance.h>
#include <gtest/gtest.h>
#include <moveit/collision_detection_fcl/collision_detector_allocator_fcl.h>
#include <moveit/planning_scene/planning_scene.h>
#include <moveit/utils/robot_model_test_utils.h>
#include <ros/ros.h>

namespace {

constexpr double PATIENCE = 15.0;  /* [s] for a message to arrive and be applied */
constexpr double TOLERANCE = 2e-4; /* [m] of FCL's distances */

class Node : public testing::Test {
 protected:
  Node() : scene_(std::make_shared<planning_scene::PlanningScene>(moveit::core::loadTestingRobotModel("panda"))) {
    publisher_ = node_.advertise<moveit_msgs::PlanningScene>("/curve_proximity/planning_scene", 1, true);
    client_ = node_.serviceClient<curve_proximity::Distance>("/curve_proximity/distance");
    EXPECT_TRUE(client_.waitForExistence(ros::Duration(PATIENCE)));
    EXPECT_EQ(scene_->getActiveCollisionDetectorName(), "FCL");
    scene_->getCurrentStateNonConst().setToDefaultValues(scene_->getRobotModel()->getJointModelGroup("panda_arm"),
                                                         "ready");
    scene_->getCurrentStateNonConst().update();
  }

  void add(const std::string &id, const shapes::ShapeConstPtr &shape, double x, double y, double z) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() << x, y, z;
    scene_->getWorldNonConst()->addToObject(id, shape, pose);
  }

  /* What the node says of the current state; its nearest object. */
  std::pair<double, std::string> ask() {
    curve_proximity::Distance call;
    trajectory_msgs::JointTrajectory state;
    state.points.resize(1);
    for (const std::string &joint : scene_->getRobotModel()->getVariableNames()) {
      if (joint == "panda_finger_joint2") continue; // it follows the other one
      state.joint_names.push_back(joint);
      state.points[0].positions.push_back(scene_->getCurrentState().getVariablePosition(joint));
    }
    call.request.query.trajectories = {state};
    if (!client_.call(call) || !call.response.success || call.response.results.empty())
      return {NAN, call.response.message};
    return {call.response.results[0].upper, call.response.results[0].b};
  }

  /* Sends a message; waits until the node answers as FCL does, and returns the nearest object. */
  std::string publish(const moveit_msgs::PlanningScene &message) {
    publisher_.publish(message);
    const double expected =
        scene_->getCollisionEnv()->distanceRobot(scene_->getCurrentState(), scene_->getAllowedCollisionMatrix());
    std::pair<double, std::string> answer;
    for (const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(PATIENCE); ros::WallTime::now() < end;) {
      answer = ask();
      if (std::abs(answer.first - expected) < TOLERANCE) return answer.second;
      ros::WallDuration(0.1).sleep();
    }
    ADD_FAILURE() << "the node says " << answer.first << " to '" << answer.second << "', FCL " << expected;
    return answer.second;
  }

  ros::NodeHandle node_;
  ros::Publisher publisher_;
  ros::ServiceClient client_;
  planning_scene::PlanningScenePtr scene_;
};

} // namespace

TEST_F(Node, answers_about_full_scenes_and_diffs_of_MoveIt) {
  /* MoveIt's message has no default for a name that sorts behind those of all entries: "table" after "panda_..." */
  add("board", std::make_shared<shapes::Box>(0.6, 1.0, 0.05), 0.6, 0.0, 0.1);
  add("can", std::make_shared<shapes::Cylinder>(0.03, 0.12), 0.5, 0.3, 0.2);
  moveit_msgs::PlanningScene message;
  scene_->getPlanningSceneMsg(message);
  const std::string first = publish(message);

  /* the nearest may be touched: another one is the nearest */
  scene_->getAllowedCollisionMatrixNonConst().setDefaultEntry(first, true);
  scene_->getPlanningSceneMsg(message);
  EXPECT_NE(publish(message), first);

  /* a diff, as a planning scene monitor sends it: a ball beside the hand */
  const auto diff = scene_->diff();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() =
      scene_->getCurrentState().getGlobalLinkTransform("panda_hand").translation() + Eigen::Vector3d(0.0, 0.25, 0.0);
  diff->getWorldNonConst()->addToObject("ball", std::make_shared<shapes::Sphere>(0.05), pose);
  diff->getPlanningSceneDiffMsg(message);
  EXPECT_TRUE(message.is_diff);
  scene_->getWorldNonConst()->addToObject("ball", std::make_shared<shapes::Sphere>(0.05), pose);
  EXPECT_EQ(publish(message), "ball");

  /* the hand takes it: attached, it is no object any more, and the can has the rest of the scene for itself */
  moveit_msgs::AttachedCollisionObject attach;
  attach.link_name = "panda_hand";
  attach.object.id = "ball";
  attach.object.operation = moveit_msgs::CollisionObject::ADD;
  ASSERT_TRUE(scene_->processAttachedCollisionObjectMsg(attach));
  scene_->getPlanningSceneMsg(message);
  EXPECT_NE(publish(message), "ball");
}

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_node");
  return RUN_ALL_TESTS();
}
