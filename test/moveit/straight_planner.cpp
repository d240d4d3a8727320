/* SPDX-License-Identifier: BSD-3-Clause */
/* A planner for tests: the straight line to joint goals, two waypoints, whatever stands between them. */
#include <moveit/planning_interface/planning_interface.h>
#include <moveit/planning_scene/planning_scene.h>
#include <moveit/robot_state/conversions.h>
#include <pluginlib/class_list_macros.hpp>

class StraightContext : public planning_interface::PlanningContext {
 public:
  using PlanningContext::PlanningContext;

  bool solve(planning_interface::MotionPlanResponse &res) override {
    moveit::core::RobotState state(planning_scene_->getCurrentState());
    moveit::core::robotStateMsgToRobotState(request_.start_state, state, true);
    res.trajectory_ = std::make_shared<robot_trajectory::RobotTrajectory>(planning_scene_->getRobotModel(), group_);
    res.trajectory_->addSuffixWayPoint(state, 0.0);
    for (const auto &joint : request_.goal_constraints.at(0).joint_constraints)
      state.setVariablePosition(joint.joint_name, joint.position);
    state.update();
    res.trajectory_->addSuffixWayPoint(state, 0.0);
    res.error_code_.val = moveit_msgs::MoveItErrorCodes::SUCCESS;
    return true;
  }
  bool solve(planning_interface::MotionPlanDetailedResponse &) override {
    return false;
  }
  bool terminate() override {
    return true;
  }
  void clear() override {}
};

class StraightPlanner : public planning_interface::PlannerManager {
 public:
  planning_interface::PlanningContextPtr getPlanningContext(const planning_scene::PlanningSceneConstPtr &scene,
                                                            const planning_interface::MotionPlanRequest &req,
                                                            moveit_msgs::MoveItErrorCodes &) const override {
    auto out = std::make_shared<StraightContext>("straight", req.group_name);
    out->setPlanningScene(scene);
    out->setMotionPlanRequest(req);
    return out;
  }
  bool canServiceRequest(const planning_interface::MotionPlanRequest &) const override {
    return true;
  }
};

PLUGINLIB_EXPORT_CLASS(StraightPlanner, planning_interface::PlannerManager)
