/* SPDX-License-Identifier: BSD-3-Clause */
/* The Panda of MoveIt's test data, its states, and a scene about it. */
#ifndef CURVE_PROXIMITY_TEST_MOVEIT_PANDA_H
#define CURVE_PROXIMITY_TEST_MOVEIT_PANDA_H

#include <moveit/planning_scene/planning_scene.h>
#include <moveit/utils/robot_model_test_utils.h>

#include <memory>

#include "collision_env.h"

inline moveit::core::RobotModelPtr panda() {
  static const moveit::core::RobotModelPtr model = moveit::core::loadTestingRobotModel("panda");
  return model;
}

inline moveit::core::RobotState ready() {
  moveit::core::RobotState state(panda());
  state.setToDefaultValues();
  state.setToDefaultValues(panda()->getJointModelGroup("panda_arm"), "ready");
  state.update();
  return state;
}

/* Ready, but for its first joint. */
inline moveit::core::RobotState turned(double angle) {
  moveit::core::RobotState state = ready();
  state.setVariablePosition("panda_joint1", angle);
  state.update();
  return state;
}

/* Ready; by our collision detector or by MoveIt's own. */
inline planning_scene::PlanningScenePtr pandaScene(bool ours) {
  auto scene = std::make_shared<planning_scene::PlanningScene>(panda());
  if (ours)
    scene->setActiveCollisionDetector(curve_proximity::CollisionDetectorAllocatorCurveProximity::create(), true);
  scene->setCurrentState(ready());
  return scene;
}

#endif
