/* SPDX-License-Identifier: BSD-3-Clause */
/* MoveIt's planning pipeline with and without the adapter, and its plugin loader with the collision detector. */
#include <gtest/gtest.h>
#include <moveit/collision_detection/collision_plugin_cache.h>
#include <moveit/collision_plugin_loader/collision_plugin_loader.h>
#include <moveit/planning_pipeline/planning_pipeline.h>
#include <moveit/planning_scene/planning_scene.h>
#include <ros/ros.h>

#include "panda.h"

namespace {

const std::string TIMING = "default_planner_request_adapters/AddTimeParameterization";
const std::string OURS = "curve_proximity/CertifyTrajectory";

/* A post that the hand of a Panda turned to `angle` is in the middle of, moved outwards by `aside` [m]. */
planning_scene::PlanningScenePtr sceneWithPost(double angle, double aside) {
  auto scene = std::make_shared<planning_scene::PlanningScene>(panda());
  scene->setCurrentState(turned(-0.8));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d hand = turned(angle).getGlobalLinkTransform("panda_hand").translation();
  pose.translation() = hand + aside * Eigen::Vector3d(hand.x(), hand.y(), 0.0).normalized();
  scene->getWorldNonConst()->addToObject("post", std::make_shared<shapes::Box>(0.01, 0.01, 0.3), pose);
  return scene;
}

/* Does a pipeline give a plan from -.8 rad to .8 rad? */
bool plans(const planning_scene::PlanningScenePtr &scene, const planning_pipeline::PlanningPipeline &pipeline,
           planning_interface::MotionPlanResponse &res) {
  planning_interface::MotionPlanRequest req;
  req.group_name = "panda_arm";
  req.max_velocity_scaling_factor = req.max_acceleration_scaling_factor = 1.0;
  req.goal_constraints.resize(1);
  const moveit::core::RobotState goal = turned(0.8);
  for (const std::string &joint : panda()->getJointModelGroup("panda_arm")->getActiveJointModelNames()) {
    moveit_msgs::JointConstraint constraint;
    constraint.joint_name = joint;
    constraint.position = goal.getVariablePosition(joint);
    req.goal_constraints[0].joint_constraints.push_back(constraint);
  }
  return pipeline.generatePlan(scene, req, res);
}

/* A parameter of the pipeline, for a scope. */
class ParameterOfPipeline {
 public:
  ParameterOfPipeline(const std::string &name, bool value) : name_(name) {
    ros::NodeHandle("~pipeline").setParam(name_, value);
  }
  ~ParameterOfPipeline() {
    ros::NodeHandle("~pipeline").deleteParam(name_);
  }
  ParameterOfPipeline(const ParameterOfPipeline &) = delete;
  ParameterOfPipeline &operator=(const ParameterOfPipeline &) = delete;

 private:
  std::string name_;
};

/* Are waypoints and times the same? */
bool isSame(const robot_trajectory::RobotTrajectory &a, const robot_trajectory::RobotTrajectory &b) {
  if (a.getWayPointCount() != b.getWayPointCount()) return false;
  for (std::size_t i = 0; i < a.getWayPointCount(); ++i) {
    if (a.getWayPointDurationFromStart(i) != b.getWayPointDurationFromStart(i)) return false;
    if (a.getWayPoint(i).distance(b.getWayPoint(i)) != 0.0) return false;
  }
  return true;
}

/* Does one with these adapters? */
bool plans(const planning_scene::PlanningScenePtr &scene, const std::vector<std::string> &adapters, double clearance,
           planning_interface::MotionPlanResponse &res) {
  ros::NodeHandle node("~pipeline");
  node.setParam("certify_clearance", clearance);
  node.setParam("certify_repair_ms", 0.0); // the planner's plan as it is
  return plans(scene, {panda(), node, "straight_planner/StraightPlanner", adapters}, res);
}

} // namespace

TEST(Pipeline, accepts_a_spline_through_a_post_and_rejects_it_with_the_adapter) {
  const auto scene = sceneWithPost(0.3, 0.0);
  planning_interface::MotionPlanResponse without, with;
  EXPECT_TRUE(plans(scene, {TIMING}, 0.0, without)) << "MoveIt looks at the waypoints";
  ASSERT_TRUE(without.trajectory_);
  EXPECT_GT(without.trajectory_->getDuration(), 0.1) << "the spline is timed";
  EXPECT_FALSE(plans(scene, {OURS, TIMING}, 0.0, with));
  EXPECT_EQ(with.error_code_.val, moveit_msgs::MoveItErrorCodes::INVALID_MOTION_PLAN);
}

TEST(Pipeline, accepts_what_is_proven_free_and_keeps_the_clearance_asked_for) {
  const auto scene = sceneWithPost(0.3, 0.3);
  planning_interface::MotionPlanResponse res;
  EXPECT_TRUE(plans(scene, {OURS, TIMING}, 0.0, res));
  EXPECT_TRUE(plans(scene, {OURS, TIMING}, 0.02, res));
  EXPECT_FALSE(plans(scene, {OURS, TIMING}, 0.5, res)) << "the post stands .3 m beside the hand's middle";
}

TEST(Pipeline, is_answered_alike_in_a_scene_of_our_detector) {
  for (const double aside : {0.0, 0.3}) {
    const auto scene = sceneWithPost(0.3, aside);
    collision_detection::CollisionPluginCache cache;
    ASSERT_TRUE(cache.activate("CurveProximity", scene, true));
    EXPECT_EQ(scene->getActiveCollisionDetectorName(), "CurveProximity");
    EXPECT_TRUE(scene->isStateColliding(turned(0.3), "panda_arm") == (aside == 0.0));
    EXPECT_FALSE(scene->diff()->isStateColliding(turned(-0.8), "panda_arm"));
    planning_interface::MotionPlanResponse res;
    EXPECT_TRUE(plans(scene, {TIMING}, 0.0, res));
    EXPECT_EQ(plans(scene, {OURS, TIMING}, 0.0, res), aside > 0.0);
  }
}

TEST(Pipeline, ends_a_plan_before_the_post_when_asked_to_shorten_it) {
  const ParameterOfPipeline shrink("certify_shrink", true);
  const auto scene = sceneWithPost(0.3, 0.0);
  planning_interface::MotionPlanResponse res;
  EXPECT_TRUE(plans(scene, {OURS, TIMING}, 0.01, res));
  ASSERT_TRUE(res.trajectory_);
  const double end = res.trajectory_->getLastWayPoint().getVariablePosition("panda_joint1");
  EXPECT_GT(end, -0.4) << "most of the way from -.8 rad to the post is free";
  EXPECT_LT(end, 0.3);
  EXPECT_EQ(res.trajectory_->getLastWayPoint().getVariableVelocity("panda_joint1"), 0.0) << "it ends at rest";

  /* what remains is free at 2000 moments by FCL, too */
  EXPECT_EQ(scene->getActiveCollisionDetectorName(), "FCL");
  auto state = std::make_shared<moveit::core::RobotState>(panda());
  for (int i = 0; i <= 2000; ++i) {
    res.trajectory_->getStateAtDurationFromStart(i / 2000.0 * res.trajectory_->getDuration(), state);
    state->update();
    ASSERT_FALSE(scene->isStateColliding(*state, "panda_arm")) << i;
    ASSERT_GT(scene->getCollisionEnv()->distanceRobot(*state, scene->getAllowedCollisionMatrix()), 0.01 - 1e-4) << i;
  }
}

/* The start is .3 m from the post: MoveIt takes the plan, and no beginning of it keeps .5 m. */
TEST(Pipeline, lets_certify_reject_decide_where_no_beginning_is_proven) {
  const auto scene = sceneWithPost(-0.8, 0.3);
  planning_interface::MotionPlanResponse whole, rejected, returned;
  ASSERT_TRUE(plans(scene, {TIMING}, 0.5, whole));

  const ParameterOfPipeline shrink("certify_shrink", true);
  EXPECT_FALSE(plans(scene, {OURS, TIMING}, 0.5, rejected));
  EXPECT_EQ(rejected.error_code_.val, moveit_msgs::MoveItErrorCodes::INVALID_MOTION_PLAN);

  const ParameterOfPipeline reject("certify_reject", false);
  ASSERT_TRUE(plans(scene, {OURS, TIMING}, 0.5, returned));
  EXPECT_TRUE(isSame(*returned.trajectory_, *whole.trajectory_));
}

/* Where a beginning is proven, the plan is shortened whether it would be rejected or not. */
TEST(Pipeline, shortens_a_plan_that_it_would_not_reject) {
  const auto scene = sceneWithPost(0.3, 0.0);
  planning_interface::MotionPlanResponse whole, shorter;
  ASSERT_TRUE(plans(scene, {TIMING}, 0.01, whole));
  const ParameterOfPipeline shrink("certify_shrink", true), reject("certify_reject", false);
  ASSERT_TRUE(plans(scene, {OURS, TIMING}, 0.01, shorter));
  EXPECT_LT(shorter.trajectory_->getLastWayPoint().getVariablePosition("panda_joint1"), 0.3);
  EXPECT_FALSE(isSame(*shorter.trajectory_, *whole.trajectory_));
}

/* A trajectory that cannot be certified at all: one without times. */
TEST(Pipeline, returns_what_cannot_be_certified_where_it_does_not_reject) {
  const auto scene = sceneWithPost(0.3, 0.3);
  planning_interface::MotionPlanResponse res;
  for (const bool shrinks : {false, true}) {
    const ParameterOfPipeline shrink("certify_shrink", shrinks);
    EXPECT_FALSE(plans(scene, {OURS}, 0.0, res)) << shrinks;
    const ParameterOfPipeline reject("certify_reject", false);
    EXPECT_TRUE(plans(scene, {OURS}, 0.0, res)) << shrinks;
  }
}

/* Just below the largest clearance that is proven, where the search has the most to do: it asks for the time after some
 * work, and a plan that needs less is proven in no time at all. */
TEST(Pipeline, rejects_what_the_budget_leaves_open_and_lets_pass_what_it_only_reports) {
  const auto scene = sceneWithPost(0.3, 0.3);
  planning_interface::MotionPlanResponse res;
  double proven = 0.0, refused = 0.5;
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (proven + refused);
    (plans(scene, {OURS, TIMING}, middle, res) ? proven : refused) = middle;
  }
  EXPECT_GT(proven, 0.01);
  EXPECT_TRUE(plans(scene, {OURS, TIMING}, proven, res));
  ros::NodeHandle("~pipeline").setParam("certify_budget_ms", 0.0);
  EXPECT_FALSE(plans(scene, {OURS, TIMING}, proven, res));
  ros::NodeHandle("~pipeline").setParam("certify_reject", false);
  EXPECT_TRUE(plans(scene, {OURS, TIMING}, proven, res));
  ros::NodeHandle("~pipeline").deleteParam("certify_budget_ms");
  ros::NodeHandle("~pipeline").deleteParam("certify_reject");
}

TEST(Pipeline, rejects_in_a_world_that_is_not_known_whole) {
  const auto scene = sceneWithPost(0.3, 0.3);
  planning_interface::MotionPlanResponse res;
  Eigen::Isometry3d far = Eigen::Isometry3d::Identity();
  far.translation().z() = 5.0;
  const auto box = std::make_shared<shapes::Box>(0.1, 0.1, 0.1);
  box->size[0] = -0.1;
  scene->getWorldNonConst()->addToObject("odd", box, far);
  EXPECT_TRUE(plans(scene, {TIMING}, 0.0, res));
  EXPECT_FALSE(plans(scene, {OURS, TIMING}, 0.0, res));
  scene->getWorldNonConst()->removeObject("odd");
  EXPECT_TRUE(plans(scene, {OURS, TIMING}, 0.0, res));
}

/* moveit_certify.launch and moveit_collision_detector.launch have set the parameters of a move_group. */
TEST(Pipeline, is_that_of_the_launch_files) {
  ros::NodeHandle move_group("/move_group");
  const planning_pipeline::PlanningPipeline pipeline(panda(), ros::NodeHandle(move_group, "planning_pipelines/ompl"),
                                                     "planning_plugin", "request_adapters");
  ASSERT_EQ(pipeline.getAdapterPluginNames().size(), 8u);
  EXPECT_EQ(pipeline.getAdapterPluginNames().front(), OURS);
  for (const double aside : {0.0, 0.3}) {
    const auto scene = sceneWithPost(0.3, aside);
    collision_detection::CollisionPluginLoader loader;
    loader.setupScene(move_group, scene);
    EXPECT_EQ(scene->getActiveCollisionDetectorName(), "CurveProximity");
    planning_interface::MotionPlanResponse res;
    ASSERT_TRUE(plans(scene, pipeline, res));
    EXPECT_EQ(res.trajectory_->getWayPointCount() > 2, aside == 0.0) << "the straight plan is led round the post";
  }
}

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_pipeline");
  ros::NodeHandle node; // keeps the node alive between pipelines
  return RUN_ALL_TESTS();
}
