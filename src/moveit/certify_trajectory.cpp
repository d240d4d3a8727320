/* SPDX-License-Identifier: BSD-3-Clause */
/* A planning request adapter. It stands before AddTimeParameterization in the list of adapters: what stands there comes
 * after it. */
#include <chrono>
#include <cmath>
#include <cstdio>

#include <moveit/planning_request_adapter/planning_request_adapter.h>
#include <moveit/planning_scene/planning_scene.h>
#include <ros/ros.h>
#include <pluginlib/class_list_macros.hpp>

#include "collision_env.h"

namespace curve_proximity {
namespace {

using Clock = std::chrono::steady_clock;

constexpr char LOG[] = "certify_trajectory";

/* Is polled by the search; true: the time is over. */
bool isOver(void *end) {
  return Clock::now() >= *static_cast<const Clock::time_point *>(end);
}

double parameter(const ros::NodeHandle &node, const std::string &name, double otherwise) {
  const double value = node.param("certify_" + name, otherwise);
  if (std::isfinite(value) && value >= 0.0) return value;
  ROS_ERROR_STREAM_NAMED(LOG, node.resolveName("certify_" + name)
                                  << " is " << value << ": it must be finite and >= 0; " << otherwise << " is used");
  return otherwise;
}

/* "link 'a' and object 'b' come within 3.2 mm at 1.25 s". */
std::string whereOf(const Answer &answer) {
  if (answer.result.status < 0) return answer.message;
  const std::string pair =
      answer.b.empty() ? "the nearest pair is not known" : "'" + answer.a + "' and '" + answer.b + "'";
  char text[128];
  std::snprintf(text, sizeof text, ": between %.6g and %.6g m at t = %.6g s", answer.result.lower, answer.result.upper,
                answer.result.t);
  return pair + text + (answer.message.empty() ? "" : " (" + answer.message + ")");
}

} // namespace

class CertifyTrajectory : public planning_request_adapter::PlanningRequestAdapter {
 public:
  void initialize(const ros::NodeHandle &node) override {
    clearance_ = parameter(node, "clearance", 0.0);
    epsilon_ = parameter(node, "epsilon", 1e-6);
    budget_ms_ = parameter(node, "budget_ms", 1000.0);
    reject_ = node.param("certify_reject", true);
  }

  std::string getDescription() const override {
    return "Certify Trajectory";
  }

  bool adaptAndPlan(const PlannerFn &planner, const planning_scene::PlanningSceneConstPtr &scene,
                    const planning_interface::MotionPlanRequest &req, planning_interface::MotionPlanResponse &res,
                    std::vector<std::size_t> &) const override {
    if (!planner(scene, req, res) || !res.trajectory_) return false;
    std::string why;
    try {
      why = faultOf(*scene, *res.trajectory_);
    } catch (const std::exception &error) {
      why = std::string("the trajectory cannot be certified: ") + error.what();
    }
    if (why.empty()) return true;
    ROS_ERROR_STREAM_NAMED(LOG, why << (reject_ ? ": the plan is rejected" : ""));
    if (!reject_) return true;
    res.error_code_.val = moveit_msgs::MoveItErrorCodes::INVALID_MOTION_PLAN;
    return false;
  }

 private:
  using Env = CollisionEnvCurveProximity;

  /* The scene's own environment where it is one of ours; else one of the same world, whose robot is kept. */
  std::shared_ptr<const Env> envOf(const planning_scene::PlanningScene &scene) const {
    if (const auto own = std::dynamic_pointer_cast<const Env>(scene.getCollisionEnv())) return own;
    const auto world = std::make_shared<collision_detection::World>(*scene.getWorld());
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!robot_ || robot_->getRobotModel() != scene.getRobotModel())
      robot_ = std::make_shared<Env>(scene.getRobotModel());
    const auto env = std::make_shared<Env>(*robot_, robot_->getWorld());
    env->setWorld(world);
    env->setLinkPadding(scene.getCollisionEnv()->getLinkPadding());
    env->setLinkScale(scene.getCollisionEnv()->getLinkScale());
    return env;
  }

  /* Why the trajectory is not proven to keep the clearance; "": it is. */
  std::string faultOf(const planning_scene::PlanningScene &scene,
                      const robot_trajectory::RobotTrajectory &trajectory) const {
    Clock::time_point end = Clock::now() + std::chrono::microseconds(std::llround(1e3 * budget_ms_));
    Query query;
    query.query_type = clearance_ > 0.0 ? QueryType::TOLERANCE : QueryType::COLLISION;
    query.delta = clearance_;
    query.options.epsilon = epsilon_;
    query.options.stop = isOver;
    query.options.stop_user = &end;
    const moveit::core::RobotState &first = trajectory.getFirstWayPoint();
    std::string out;
    for (const Answer &answer : envOf(scene)->ask(timed(trajectory), first, scene.getAllowedCollisionMatrix(), query)) {
      if (answer.result.status >= 0 && answer.result.verdict == CPROX_VERDICT_CLEAR) continue;
      const char *verdict = answer.result.status < 0 ? "failed" : cprox_verdict_name(answer.result.verdict);
      out += (out.empty() ? "" : "; ") + answer.kind + ": " + verdict + ", " + whereOf(answer);
    }
    return out;
  }

  double clearance_ = 0.0, epsilon_ = 1e-6, budget_ms_ = 1000.0;
  bool reject_ = true;
  mutable std::mutex mutex_; /* of robot_ */
  mutable std::shared_ptr<Env> robot_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::CertifyTrajectory, planning_request_adapter::PlanningRequestAdapter)
