/* SPDX-License-Identifier: BSD-3-Clause */
/* Our node, asked how close the current state of a scene of MoveIt comes to the objects. */
#ifndef CURVE_PROXIMITY_TEST_MOVEIT_LIVE_NODE_H
#define CURVE_PROXIMITY_TEST_MOVEIT_LIVE_NODE_H

#include <curve_proximity/Distance.h>
#include <gtest/gtest.h>
#include <moveit/planning_scene/planning_scene.h>
#include <ros/ros.h>

#include <cmath>
#include <string>
#include <utility>

class LiveNode {
 public:
  static constexpr double PATIENCE = 15.0;  /* [s] for a message to arrive and be applied */
  static constexpr double TOLERANCE = 2e-4; /* [m] of FCL's distances */

  LiveNode() : client_(node_.serviceClient<curve_proximity::Distance>("/curve_proximity/distance")) {
    EXPECT_TRUE(client_.waitForExistence(ros::Duration(PATIENCE)));
  }

  /* The distance of the current state to the objects, by FCL. */
  static double distanceIn(const planning_scene::PlanningScene &scene) {
    EXPECT_EQ(scene.getActiveCollisionDetectorName(), "FCL");
    return scene.getCollisionEnv()->distanceRobot(scene.getCurrentState(), scene.getAllowedCollisionMatrix());
  }

  /* Waits until the node answers as the scene's detector does, and returns the nearest object. */
  std::string agreesWith(const planning_scene::PlanningScene &scene) {
    return says(distanceIn(scene), scene);
  }

  /* The same of a distance that is expected. */
  std::string says(double expected, const planning_scene::PlanningScene &scene) {
    std::pair<double, std::string> answer;
    for (const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(PATIENCE); ros::WallTime::now() < end;) {
      answer = ask(scene.getCurrentState());
      if (std::abs(answer.first - expected) < TOLERANCE) return answer.second;
      ros::WallDuration(0.1).sleep();
    }
    ADD_FAILURE() << "the node says " << answer.first << " to '" << answer.second << "', expected was " << expected;
    return answer.second;
  }

 private:
  std::pair<double, std::string> ask(const moveit::core::RobotState &state) {
    curve_proximity::Distance call;
    trajectory_msgs::JointTrajectory point;
    point.points.resize(1);
    for (const moveit::core::JointModel *joint : state.getRobotModel()->getActiveJointModels()) {
      if (joint->getMimic()) continue;
      for (const std::string &variable : joint->getVariableNames()) {
        point.joint_names.push_back(variable);
        point.points[0].positions.push_back(state.getVariablePosition(variable));
      }
    }
    call.request.query.trajectories = {point};
    if (!client_.call(call) || !call.response.success || call.response.results.empty())
      return {NAN, call.response.message};
    return {call.response.results[0].upper, call.response.results[0].b};
  }

  ros::NodeHandle node_;
  ros::ServiceClient client_;
};

/* A Panda's ready posture. */
inline void makeReady(moveit::core::RobotState &state) {
  state.setToDefaultValues();
  state.setToDefaultValues(state.getRobotModel()->getJointModelGroup("panda_arm"), "ready");
  state.update();
}

inline void addObject(planning_scene::PlanningScene &scene, const std::string &id, const shapes::ShapeConstPtr &shape,
                      const Eigen::Vector3d &at) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = at;
  scene.getWorldNonConst()->addToObject(id, shape, pose);
}

/* Moves an object of the world to the hand. */
inline moveit_msgs::AttachedCollisionObject taken(const std::string &id) {
  moveit_msgs::AttachedCollisionObject out;
  out.link_name = "panda_hand";
  out.object.id = id;
  out.object.operation = moveit_msgs::CollisionObject::ADD;
  return out;
}

#endif
