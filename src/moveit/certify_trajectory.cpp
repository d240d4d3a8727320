/* SPDX-License-Identifier: BSD-3-Clause */
/* A planning request adapter. It stands before AddTimeParameterization in the list of adapters: what stands there comes
 * after it. */
#include <chrono>
#include <cmath>
#include <cstdio>

#include <moveit/planning_request_adapter/planning_request_adapter.h>
#include <moveit/planning_scene/planning_scene.h>
#include <moveit/trajectory_processing/iterative_time_parameterization.h>
#include <ros/ros.h>
#include <pluginlib/class_list_macros.hpp>

#include "collision_env.h"

namespace curve_proximity {
namespace {

using Clock = std::chrono::steady_clock;

constexpr char LOG[] = "certify_trajectory";
constexpr double RESOLUTION = 1000.0; /* parts of a duration: how closely intervals are told */
constexpr int SHRINK_STEPS = 8;       /* ends that are tried for a shorter plan */

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

/* "from 1.2 to 1.35 s, from 2 to 2.1 s". */
std::string textOf(const Violations &violations) {
  std::string out;
  for (const Violation &violation : violations.list) {
    char text[80];
    std::snprintf(text, sizeof text, "%sfrom %.4g to %.4g s", out.empty() ? "" : ", ", violation.enter_lower,
                  violation.leave_upper);
    out += text;
  }
  return out;
}

} // namespace

class CertifyTrajectory : public planning_request_adapter::PlanningRequestAdapter {
 public:
  void initialize(const ros::NodeHandle &node) override {
    clearance_ = parameter(node, "clearance", 0.0);
    epsilon_ = parameter(node, "epsilon", 1e-6);
    budget_ms_ = parameter(node, "budget_ms", 1000.0);
    reject_ = node.param("certify_reject", true);
    shrink_ = node.param("certify_shrink", false);
  }

  std::string getDescription() const override {
    return "Certify Trajectory";
  }

  bool adaptAndPlan(const PlannerFn &planner, const planning_scene::PlanningSceneConstPtr &scene,
                    const planning_interface::MotionPlanRequest &req, planning_interface::MotionPlanResponse &res,
                    std::vector<std::size_t> &) const override {
    if (!planner(scene, req, res) || !res.trajectory_) return false;
    const Finding finding = certify(*scene, *res.trajectory_);
    if (finding.why.empty()) return true;
    if (shrink_ && shrink(*scene, req, finding, res)) return true;
    const std::string why = finding.why + (shrink_ ? "; no beginning of it is proven" : "");
    if (!reject_) {
      ROS_ERROR_STREAM_NAMED(LOG, why << ": the plan is returned as it is, certify_reject is false");
      return true;
    }
    ROS_ERROR_STREAM_NAMED(LOG, why << ": the plan is rejected");
    res.error_code_.val = moveit_msgs::MoveItErrorCodes::INVALID_MOTION_PLAN;
    return false;
  }

 private:
  using Env = CollisionEnvCurveProximity;
  using Trajectory = robot_trajectory::RobotTrajectory;

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

  /* What is known of a trajectory. */
  struct Finding {
    std::string why;          /* why it is not proven to keep the clearance; "": it is */
    double clear_until = 0.0; /* [s] proven up to here, where `why` is not "" */
  };

  Finding certify(const planning_scene::PlanningScene &scene, const Trajectory &trajectory) const {
    try {
      if (trajectory.getWayPointCount() == 0) throw Error("it has no waypoint");
      const RobotMotion motion =
          envOf(scene)->motion(timed(trajectory), trajectory.getFirstWayPoint(), scene.getAllowedCollisionMatrix());
      Finding out;
      out.clear_until = motion.domain()[1];
      for (const bool self : {false, true}) look(motion, self, out);
      return out;
    } catch (const std::exception &error) {
      return {std::string("the trajectory cannot be certified: ") + error.what(), 0.0};
    }
  }

  /* Asks about the objects, or about the robot itself; adds to the finding what is not proven, where and by how much.
   */
  void look(const RobotMotion &motion, bool self, Finding &out) const {
    Workspace workspace;
    Clock::time_point end = Clock::now() + std::chrono::microseconds(std::llround(1e3 * budget_ms_));
    Query query;
    query.query_type = clearance_ > 0.0 ? QueryType::TOLERANCE : QueryType::COLLISION;
    query.delta = clearance_;
    query.allow_empty = true; // MoveIt's scene is whole
    query.options.epsilon = epsilon_;
    query.options.stop = isOver;
    query.options.stop_user = &end;
    const auto ask = [&] {
      return self ? askSelf(motion, query, workspace) : askEnvironment(motion, query, workspace).front();
    };
    Answer answer = ask();
    if (answer.result.status >= 0 && answer.result.verdict == CPROX_VERDICT_CLEAR) return;
    if (!out.why.empty()) out.why += "; ";
    out.why += answer.kind + ": ";
    if (answer.result.status < 0) {
      out.why += "failed, " + answer.message;
      out.clear_until = 0.0;
      return;
    }
    out.why += cprox_verdict_name(answer.result.verdict);
    std::string remark = answer.message.empty() ? "" : " (" + answer.message + ")";

    /* Where? Of a robot that stands: everywhere. */
    end = Clock::now() + std::chrono::microseconds(std::llround(1e3 * budget_ms_));
    query.query_type = QueryType::TOLERANCE;
    const double duration = motion.domain()[1] - motion.domain()[0];
    Violations where;
    if (!motion.stands()) where = violations(motion, self, duration / RESOLUTION, query, workspace);
    const double clear_until = where.list.empty() ? 0.0 : where.list.front().enter_lower;
    out.clear_until = std::min(out.clear_until, clear_until);

    /* By how much? In contact by the depth, where that is known. */
    query.query_type = QueryType::DISTANCE;
    query.delta = 0.0;
    const Answer distance = ask();
    if (distance.result.status == CPROX_OK) answer = distance;
    if (answer.result.upper <= 0.0) {
      query.options.signed_distance = 1;
      try {
        const Answer depth = ask();
        if (depth.result.status == CPROX_OK) answer = depth;
      } catch (const Error &) {
      }
    }
    char text[160];
    std::snprintf(text, sizeof text, ": between %.6g and %.6g m%s at t = %.4g s, up to %.3g m less than asked",
                  answer.result.lower, answer.result.upper, answer.by_hull ? " of convex hulls" : "", answer.result.t,
                  std::max(0.0, clearance_ - answer.result.lower));
    const std::string intervals = textOf(where);
    out.why += ", " +
               (answer.b.empty() ? "the nearest pair is not known" : "'" + answer.a + "' and '" + answer.b + "'") +
               text + (intervals.empty() ? "" : ", not proven " + intervals) + remark;
  }

  /* Replaces the plan by a beginning of it that is timed anew, ends at rest and is proven. false: there is none. */
  bool shrink(const planning_scene::PlanningScene &scene, const planning_interface::MotionPlanRequest &req,
              const Finding &finding, planning_interface::MotionPlanResponse &res) const {
    const Trajectory &whole = *res.trajectory_;
    for (int parts = SHRINK_STEPS; parts > 0 && finding.clear_until > 0.0; --parts) {
      const double end = finding.clear_until * parts / SHRINK_STEPS;
      const robot_trajectory::RobotTrajectoryPtr shorter = upTo(whole, end);
      if (!trajectory_processing::IterativeParabolicTimeParameterization().computeTimeStamps(
              *shorter, req.max_velocity_scaling_factor, req.max_acceleration_scaling_factor))
        return false;
      if (!certify(scene, *shorter).why.empty()) continue;
      ROS_WARN_STREAM_NAMED(LOG, finding.why << ": the plan is shortened, it ends where it was at t = " << end << " of "
                                             << whole.getDuration() << " s");
      res.trajectory_ = shorter;
      return true;
    }
    return false;
  }

  double clearance_ = 0.0, epsilon_ = 1e-6, budget_ms_ = 1000.0;
  bool reject_ = true, shrink_ = false;
  mutable std::mutex mutex_; /* of robot_ */
  mutable std::shared_ptr<Env> robot_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::CertifyTrajectory, planning_request_adapter::PlanningRequestAdapter)
