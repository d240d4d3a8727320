/* SPDX-License-Identifier: BSD-3-Clause */
/* The adapter with planners that answer as the test wants: when it repairs a plan or plans again, what it returns and what it
 * publishes. */
#include <gtest/gtest.h>
#include <moveit/planning_request_adapter/planning_request_adapter.h>
#include <moveit/planning_scene/planning_scene.h>
#include <moveit/trajectory_processing/time_optimal_trajectory_generation.h>
#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>
#include <pluginlib/class_loader.hpp>

#include <curve_proximity/ViolationIntervals.h>

#include "panda.h"

namespace {

using planning_interface::MotionPlanRequest;
using planning_interface::MotionPlanResponse;
using planning_request_adapter::PlanningRequestAdapter;

class Attempts : public testing::Test {
 protected:
  Attempts()
      : loader_("moveit_core", "planning_request_adapter::PlanningRequestAdapter"),
        scene_(std::make_shared<planning_scene::PlanningScene>(panda())) {
    const Eigen::Vector3d hand = turned(0.3).getGlobalLinkTransform("panda_hand").translation();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = hand;
    scene_->getWorldNonConst()->addToObject("post", std::make_shared<shapes::Box>(0.01, 0.01, 0.3), pose);
    req_.group_name = "panda_arm";
    req_.allowed_planning_time = 60.0;
    req_.max_velocity_scaling_factor = req_.max_acceleration_scaling_factor = 1.0;
  }

  /* A plan from -.8 rad to an angle: the post stands at .3 rad. */
  static robot_trajectory::RobotTrajectoryPtr planTo(double angle) {
    auto out = std::make_shared<robot_trajectory::RobotTrajectory>(panda(), "panda_arm");
    out->addSuffixWayPoint(turned(-0.8), 0.0);
    out->addSuffixWayPoint(turned(angle), 0.0);
    EXPECT_TRUE(trajectory_processing::TimeOptimalTrajectoryGeneration().computeTimeStamps(*out));
    return out;
  }

  /* The adapter's answer with a planner that gives these plans in turn, the last one again and again; NaN: none. */
  bool plans(int attempts, const std::vector<double> &angles) {
    ros::NodeHandle node("~pipeline");
    node.setParam("certify_attempts", attempts);
    node.setParam("certify_repair_ms", repair_ms_);
    node.setParam("certify_clearance", clearance_);
    const auto adapter = loader_.createUniqueInstance("curve_proximity/CertifyTrajectory");
    adapter->initialize(node);
    asked_ = 0;
    const auto planner = [&](const planning_scene::PlanningSceneConstPtr &, const MotionPlanRequest &,
                             MotionPlanResponse &res) {
      const double angle = angles[std::min(asked_++, angles.size() - 1)];
      if (std::isnan(angle)) return false;
      res.trajectory_ = planTo(angle);
      res.error_code_.val = moveit_msgs::MoveItErrorCodes::SUCCESS;
      return true;
    };
    std::vector<std::size_t> added;
    res_ = MotionPlanResponse();
    return adapter->adaptAndPlan(planner, scene_, req_, res_, added);
  }

  double end() const {
    return res_.trajectory_->getLastWayPoint().getVariablePosition("panda_joint1");
  }

  pluginlib::ClassLoader<PlanningRequestAdapter> loader_;
  planning_scene::PlanningScenePtr scene_;
  MotionPlanRequest req_;
  MotionPlanResponse res_;
  std::size_t asked_ = 0;
  double repair_ms_ = 0.0, clearance_ = 0.0;
};

const double NONE = std::numeric_limits<double>::quiet_NaN();

} // namespace

TEST_F(Attempts, end_with_the_first_plan_that_is_proven) {
  EXPECT_TRUE(plans(3, {0.8, -0.4}));
  EXPECT_EQ(asked_, 2u);
  EXPECT_EQ(end(), -0.4);
  EXPECT_TRUE(plans(3, {-0.4}));
  EXPECT_EQ(asked_, 1u);
}

TEST_F(Attempts, are_as_many_as_the_parameter_says) {
  EXPECT_FALSE(plans(1, {0.8, -0.4}));
  EXPECT_EQ(asked_, 1u);
  EXPECT_FALSE(plans(3, {0.8, 0.7, 0.6, -0.4}));
  EXPECT_EQ(asked_, 3u);
  EXPECT_EQ(res_.error_code_.val, moveit_msgs::MoveItErrorCodes::INVALID_MOTION_PLAN);
  EXPECT_TRUE(plans(4, {0.8, 0.7, 0.6, -0.4}));
  EXPECT_FALSE(plans(0, {0.8, -0.4})) << "0 counts as 1";
}

TEST_F(Attempts, end_where_the_planner_gives_the_same_plan_again) {
  EXPECT_FALSE(plans(9, {0.8}));
  EXPECT_EQ(asked_, 2u);
}

TEST_F(Attempts, go_on_where_the_planner_finds_nothing) {
  EXPECT_TRUE(plans(3, {0.8, NONE, -0.4}));
  EXPECT_EQ(asked_, 3u);
  EXPECT_FALSE(plans(3, {NONE, -0.4})) << "without a first plan there is nothing to certify";
  EXPECT_EQ(asked_, 1u);
}

TEST_F(Attempts, end_when_the_planning_time_is_over) {
  req_.allowed_planning_time = 0.0;
  EXPECT_FALSE(plans(3, {0.8, -0.4}));
  EXPECT_EQ(asked_, 1u);
}

/* The way round is free by FCL at 2000 moments of MoveIt's own interpolation, too. */
TEST_F(Attempts, lead_a_plan_round_a_post) {
  repair_ms_ = 5000.0;
  for (const double clearance : {0.0, 0.02}) {
    clearance_ = clearance;
    ASSERT_TRUE(plans(1, {0.8})) << clearance;
    EXPECT_EQ(asked_, 1u);
    EXPECT_EQ(res_.trajectory_->getFirstWayPoint().distance(turned(-0.8)), 0.0);
    EXPECT_EQ(res_.trajectory_->getLastWayPoint().distance(turned(0.8)), 0.0);
    EXPECT_EQ(res_.trajectory_->getLastWayPoint().getVariableVelocity("panda_joint1"), 0.0) << "it ends at rest";
    ASSERT_EQ(scene_->getActiveCollisionDetectorName(), "FCL");
    auto state = std::make_shared<moveit::core::RobotState>(panda());
    for (int i = 0; i <= 2000; ++i) {
      res_.trajectory_->getStateAtDurationFromStart(i / 2000.0 * res_.trajectory_->getDuration(), state);
      state->update();
      ASSERT_TRUE(state->satisfiesBounds(panda()->getJointModelGroup("panda_arm"), 1e-9)) << i;
      ASSERT_FALSE(scene_->isStateColliding(*state, "panda_arm")) << i;
      ASSERT_GT(scene_->getCollisionEnv()->distanceRobot(*state, scene_->getAllowedCollisionMatrix()), clearance - 1e-4)
          << i;
    }
  }
}

TEST_F(Attempts, plan_again_where_there_is_no_way_round) {
  repair_ms_ = 300.0;
  EXPECT_TRUE(plans(3, {0.3, -0.4})) << "the post is in the goal of the first plan";
  EXPECT_EQ(asked_, 2u);
  EXPECT_EQ(end(), -0.4);
}

TEST_F(Attempts, leave_a_plan_on_its_way_where_the_path_is_constrained) {
  repair_ms_ = 5000.0;
  req_.path_constraints.joint_constraints.resize(1);
  req_.path_constraints.joint_constraints[0].joint_name = "panda_joint2";
  EXPECT_FALSE(plans(1, {0.8}));
}

TEST_F(Attempts, publish_the_pair_that_is_not_proven) {
  ros::NodeHandle node("~pipeline");
  std::vector<curve_proximity::ViolationIntervals> told;
  std::size_t markers = 0;
  const auto of_pairs = node.subscribe<curve_proximity::ViolationIntervals>(
      "certify/violations", 9,
      [&](const curve_proximity::ViolationIntervals::ConstPtr &message) { told.push_back(*message); });
  const auto of_markers = node.subscribe<visualization_msgs::MarkerArray>(
      "certify/markers", 9,
      [&](const visualization_msgs::MarkerArray::ConstPtr &message) { markers = message->markers.size(); });
  node.setParam("certify_attempts", 1);
  node.setParam("certify_repair_ms", 0.0);
  node.setParam("certify_clearance", 0.0);
  const auto adapter = loader_.createUniqueInstance("curve_proximity/CertifyTrajectory");
  adapter->initialize(node);
  const auto planner = [&](const planning_scene::PlanningSceneConstPtr &, const MotionPlanRequest &,
                           MotionPlanResponse &res) {
    res.trajectory_ = planTo(0.8);
    return true;
  };
  std::vector<std::size_t> added;
  EXPECT_FALSE(adapter->adaptAndPlan(planner, scene_, req_, res_, added));
  for (int i = 0; i < 500 && (told.empty() || markers == 0); ++i) {
    ros::spinOnce();
    ros::WallDuration(0.02).sleep();
  }
  ASSERT_EQ(told.size(), 1u) << "the robot itself is clear";
  EXPECT_EQ(told[0].summary.b, "post");
  EXPECT_EQ(told[0].summary.verdict, "violated");
  EXPECT_LE(told[0].summary.lower, 0.0) << "the depth, if there was time for it";
  ASSERT_EQ(told[0].t.size(), 1u);
  EXPECT_LE(told[0].enter_lower[0], told[0].summary.t);
  EXPECT_GE(told[0].leave_upper[0], told[0].summary.t);
  EXPECT_EQ(markers, 4u);
}

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_attempts");
  ros::NodeHandle node;
  return RUN_ALL_TESTS();
}
