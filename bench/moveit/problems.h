/* SPDX-License-Identifier: BSD-3-Clause */
/* Planning problems of MotionBenchMaker as requests of MoveIt. */
#ifndef CURVE_PROXIMITY_BENCH_MOVEIT_PROBLEMS_H
#define CURVE_PROXIMITY_BENCH_MOVEIT_PROBLEMS_H

#include <memory>
#include <string>

#include <yaml-cpp/yaml.h>

#include <moveit/kinematic_constraints/utils.h>
#include <moveit/planning_scene/planning_scene.h>
#include <moveit/robot_state/conversions.h>
#include <moveit_msgs/MotionPlanRequest.h>
#include <ros/node_handle.h>
#include <urdf_parser/urdf_parser.h>

#include "worlds.h"

constexpr double UR5_HEIGHT = 0.9144, UR5_TURN = 1.57; /* where the UR5 of MotionBenchMaker stands */
constexpr double GOAL_TOLERANCE = 1e-9;                /* [rad]: MoveIt's samples of the goal are not seeded */

struct Problem {
  std::string name, group;
  planning_scene::PlanningScenePtr scene;
  std::shared_ptr<moveit::core::RobotState> from, to;
};

inline moveit::core::RobotModelPtr robotModel(const ros::NodeHandle &node) {
  std::string urdf_text, srdf_text;
  if (!node.getParam("robot_description", urdf_text) || !node.getParam("robot_description_semantic", srdf_text))
    throw curve_proximity::Error("there is no robot_description, or no robot_description_semantic");
  const auto urdf = urdf::parseURDF(urdf_text);
  auto srdf = std::make_shared<srdf::Model>();
  if (!urdf || !srdf->initString(*urdf, srdf_text)) throw curve_proximity::Error("the robot cannot be read");
  return std::make_shared<moveit::core::RobotModel>(urdf, srdf);
}

inline Eigen::Isometry3d frameOf(const moveit::core::RobotModel &model) {
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
  if (model.getName().compare(0, 3, "ur5") == 0)
    base = Eigen::Translation3d(0.0, 0.0, UR5_HEIGHT) * Eigen::AngleAxisd(UR5_TURN, Eigen::Vector3d::UnitZ());
  return base.inverse();
}

/* Two that touch, by FCL; "": none do. */
inline std::string pairInContact(const planning_scene::PlanningScene &scene, const moveit::core::RobotState &state,
                                 const std::string &group) {
  collision_detection::CollisionRequest req;
  collision_detection::CollisionResult res;
  req.contacts = true;
  req.group_name = group;
  scene.checkCollision(req, res, state);
  if (!res.collision) return "";
  const auto &[a, b] = res.contacts.begin()->first;
  return "'" + a + "' and '" + b + "'";
}

/* The start has joints that the UR5 lacks (a gripper), and the Panda's fingers beyond their limits, where they are free. */
inline Problem problemOf(const moveit::core::RobotModelPtr &model, const std::string &scene,
                         const std::string &request) {
  Problem out;
  const YAML::Node file = YAML::LoadFile(request), start = file["start_state"]["joint_state"];
  out.group = file["group_name"].as<std::string>();
  const std::string folder = scene.substr(0, scene.rfind('/')), stem = scene.substr(folder.size() + 1);
  out.name = folder.substr(folder.rfind('/') + 1) + "/" + stem.substr(0, stem.rfind('.'));
  out.scene = std::make_shared<planning_scene::PlanningScene>(model, worldOf(scene, frameOf(*model)));
  out.from = std::make_shared<moveit::core::RobotState>(model);
  out.from->setToDefaultValues();
  for (std::size_t i = 0; i < start["name"].size(); ++i) {
    const auto name = start["name"][i].as<std::string>();
    if (model->hasJointModel(name)) out.from->setVariablePosition(name, start["position"][i].as<double>());
  }
  out.to = std::make_shared<moveit::core::RobotState>(*out.from);
  for (const YAML::Node &joint : file["goal_constraints"][0]["joint_constraints"])
    out.to->setVariablePosition(joint["joint_name"].as<std::string>(), joint["position"].as<double>());
  out.from->update();
  out.to->update();
  for (const moveit::core::RobotState *state : {out.from.get(), out.to.get()}) {
    const std::string pair = pairInContact(*out.scene, *state, out.group);
    if (!pair.empty()) throw curve_proximity::Error(out.name + ": the start or the goal is in collision: " + pair);
  }
  out.scene->setCurrentState(*out.from);
  return out;
}

/* One plan from the start to the goal, as fast as the robot can. */
inline moveit_msgs::MotionPlanRequest requestOf(const Problem &problem, double planning_time) {
  moveit_msgs::MotionPlanRequest req;
  req.group_name = problem.group;
  req.num_planning_attempts = 1;
  req.allowed_planning_time = planning_time;
  req.max_velocity_scaling_factor = req.max_acceleration_scaling_factor = 1.0;
  moveit::core::robotStateToRobotStateMsg(*problem.from, req.start_state);
  const auto *group = problem.scene->getRobotModel()->getJointModelGroup(problem.group);
  req.goal_constraints.push_back(kinematic_constraints::constructGoalConstraints(*problem.to, group, GOAL_TOLERANCE));
  return req;
}

#endif
