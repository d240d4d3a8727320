/* SPDX-License-Identifier: BSD-3-Clause */
/* The question that MoveIt asks, beside its FCL detector: links that stand, planes. Needs a master for a parameter. */
#include <gtest/gtest.h>
#include <moveit/planning_scene/planning_scene.h>
#include <ros/ros.h>

#include <random>

#include "certifier.h"
#include "panda.h"

/* 40 plates (seed 47), wider than the first link, beside and in it, which no joint moves: a motion of the last joint is in collision where FCL's state
 * is. */
TEST(Question, is_about_links_that_stand_too) {
  std::mt19937 generator(47);
  const auto random = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  const curve_proximity::Certifier certifier;
  int hits = 0;
  for (int i = 0; i < 40; ++i) {
    const auto by_fcl = pandaScene(false), by_us = pandaScene(true);
    const Eigen::Isometry3d pose(Eigen::Translation3d(random(-0.35, 0.35), random(-0.35, 0.35), random(-0.1, 0.1)));
    for (const auto &scene : {by_fcl, by_us})
      scene->getWorldNonConst()->addToObject("box", std::make_shared<shapes::Box>(0.25, 0.25, 0.02), pose);
    const moveit::core::RobotState from(by_us->getCurrentState());
    moveit::core::RobotState to(from);
    to.setVariablePosition("panda_joint7", from.getVariablePosition("panda_joint7") + 0.1);
    to.update();
    const bool collides = by_fcl->isStateColliding(from);
    EXPECT_EQ(by_us->isStateColliding(from), collides) << i;
    collision_detection::CollisionResult res;
    by_us->getCollisionEnv()->checkRobotCollision({}, res, from, to, by_us->getAllowedCollisionMatrix());
    EXPECT_EQ(res.collision, collides) << i;
    robot_trajectory::RobotTrajectory plan(by_fcl->getRobotModel(), "panda_arm");
    plan.addSuffixWayPoint(from, 0.0);
    plan.addSuffixWayPoint(to, 1.0);
    for (const auto &scene : {by_fcl, by_us})
      EXPECT_EQ(certifier.certify(*scene, plan, {}).why.empty(), !collides) << i;
    hits += collides ? 1 : 0;
  }
  EXPECT_GT(hits, 5);
  EXPECT_LT(hits, 35);
}

/* shape_msgs says ax + by + cz + d = 0, MoveIt's FCL takes ax + by + cz = d. */
TEST(Question, takes_planes_as_shape_msgs_says_and_by_a_parameter_as_fcl_does) {
  for (const double d : {0.5, -0.5}) {
    const auto collides = [d](bool ours, bool like_fcl) {
      ros::param::set("~curve_proximity/planes_like_fcl", like_fcl);
      const auto scene = pandaScene(ours);
      scene->getWorldNonConst()->addToObject("plane", std::make_shared<shapes::Plane>(0.0, 0.0, 1.0, d),
                                             Eigen::Isometry3d::Identity());
      return scene->isStateColliding(scene->getCurrentState());
    };
    EXPECT_EQ(collides(true, false), d < 0.0) << d;
    EXPECT_EQ(collides(true, true), d > 0.0) << d;
    EXPECT_EQ(collides(false, false), d > 0.0) << d;
  }
}

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_question");
  ros::Time::init();
  return RUN_ALL_TESTS();
}
