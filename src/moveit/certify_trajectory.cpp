/* SPDX-License-Identifier: BSD-3-Clause */
/* A planning request adapter. It stands before AddTimeParameterization in the list of adapters: what stands there comes
 * after it. */
#include <chrono>
#include <cmath>

#include <moveit/planning_request_adapter/planning_request_adapter.h>
#include <moveit/planning_scene/planning_scene.h>
#include <moveit/trajectory_processing/iterative_time_parameterization.h>
#include <ros/ros.h>
#include <pluginlib/class_list_macros.hpp>

#include "repair.h"
#include "violation_message.h"

namespace curve_proximity {
namespace {

using Clock = std::chrono::steady_clock;
using planning_interface::MotionPlanRequest;
using planning_interface::MotionPlanResponse;
using Trajectory = robot_trajectory::RobotTrajectory;

constexpr char ADAPTER_LOG[] = "certify_trajectory";
constexpr int SHRINK_STEPS = 8; /* ends that are tried for a shorter plan */

double parameter(const ros::NodeHandle &node, const std::string &name, double otherwise) {
  const double value = node.param("certify_" + name, otherwise);
  if (std::isfinite(value) && value >= 0.0) return value;
  ROS_ERROR_STREAM_NAMED(ADAPTER_LOG, node.resolveName("certify_" + name)
                                          << " is " << value << ": it must be finite and >= 0; " << otherwise
                                          << " is used");
  return otherwise;
}

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/* Does a planner give the same path again? */
bool isSame(const Trajectory &a, const Trajectory &b) {
  if (a.getWayPointCount() != b.getWayPointCount()) return false;
  for (std::size_t i = 0; i < a.getWayPointCount(); ++i)
    if (a.getWayPoint(i).distance(b.getWayPoint(i)) != 0.0) return false;
  return true;
}

} // namespace

class CertifyTrajectory : public planning_request_adapter::PlanningRequestAdapter {
 public:
  void initialize(const ros::NodeHandle &node) override {
    settings_.clearance = parameter(node, "clearance", 0.0);
    settings_.epsilon = parameter(node, "epsilon", 1e-6);
    settings_.budget_ms = parameter(node, "budget_ms", 1000.0);
    repair_ms_ = parameter(node, "repair_ms", 200.0);
    attempts_ = node.param("certify_attempts", 3);
    if (attempts_ < 1) {
      ROS_ERROR_STREAM_NAMED(ADAPTER_LOG, node.resolveName("certify_attempts")
                                              << " is " << attempts_ << ": it must be at least 1; 1 is used");
      attempts_ = 1;
    }
    reject_ = node.param("certify_reject", true);
    shrink_ = node.param("certify_shrink", false);
    ros::NodeHandle topics(node, "certify");
    violations_ = topics.advertise<ViolationIntervals>("violations", 8, true);
    markers_ = topics.advertise<visualization_msgs::MarkerArray>("markers", 1, true);
  }

  std::string getDescription() const override {
    return "Certify Trajectory";
  }

  bool adaptAndPlan(const PlannerFn &planner, const planning_scene::PlanningSceneConstPtr &scene,
                    const MotionPlanRequest &req, MotionPlanResponse &res, std::vector<std::size_t> &) const override {
    const Clock::time_point begin = Clock::now();
    std::vector<MotionPlanResponse> refused;
    double planning_time = 0.0;
    int asked = 0;
    do {
      res = MotionPlanResponse();
      const bool is_planned = planner(scene, req, res) && res.trajectory_;
      ++asked;
      planning_time += res.planning_time_;
      res.planning_time_ = planning_time;
      if (!is_planned && refused.empty()) return false;
      if (!is_planned) continue; // a planner by chance may find one next time
      if (!refused.empty() && isSame(*res.trajectory_, *refused.back().trajectory_)) break;
      const Finding finding = certifier_.judge(*scene, *res.trajectory_, settings_);
      if (finding.why.empty()) {
        report(*scene, finding);
        if (!refused.empty())
          ROS_INFO_STREAM_NAMED(ADAPTER_LOG, "plan " << asked << " is proven, those before it were not");
        return true;
      }
      if (const auto other = repair(*scene, req, res, finding)) {
        ROS_INFO_STREAM_NAMED(ADAPTER_LOG, finding.why << ": the plan is led round that, its duration is "
                                                       << other->getDuration() << " s instead of "
                                                       << res.trajectory_->getDuration());
        res.trajectory_ = other;
        report(*scene, Finding());
        return true;
      }
      refused.push_back(res);
    } while (asked < attempts_ && secondsSince(begin) < req.allowed_planning_time);
    Finding finding = longestProven(*scene, refused, res);
    res.planning_time_ = planning_time;
    report(*scene, finding);
    if (refused.size() > 1) finding.why += "; so are " + std::to_string(refused.size() - 1) + " other plans";
    if (shrink_ && shrink(*scene, req, finding, res)) return true;
    const std::string why = finding.why + (shrink_ ? "; no beginning of it is proven" : "");
    if (!reject_) {
      ROS_ERROR_STREAM_NAMED(ADAPTER_LOG, why << ": the plan is returned as it is, certify_reject is false");
      return true;
    }
    ROS_ERROR_STREAM_NAMED(ADAPTER_LOG, why << ": the plan is rejected");
    res.error_code_.val = moveit_msgs::MoveItErrorCodes::INVALID_MOTION_PLAN;
    return false;
  }

 private:
  /* Of plans that are not proven the one that is proven for the longest time. */
  Finding longestProven(const planning_scene::PlanningScene &scene, const std::vector<MotionPlanResponse> &refused,
                        MotionPlanResponse &res) const {
    Finding out;
    for (const MotionPlanResponse &plan : refused) {
      Finding finding = certifier_.certify(scene, *plan.trajectory_, settings_);
      if (&plan != &refused.front() && finding.clear_until <= out.clear_until) continue;
      out = std::move(finding);
      res = plan;
    }
    return out;
  }

  robot_trajectory::RobotTrajectoryPtr repair(const planning_scene::PlanningScene &scene, const MotionPlanRequest &req,
                                              const MotionPlanResponse &res, const Finding &finding) const {
    if (repair_ms_ <= 0.0) return nullptr;
    return repaired(certifier_, scene, req, *res.trajectory_, finding, settings_, repair_ms_);
  }

  void report(const planning_scene::PlanningScene &scene, const Finding &finding) const {
    for (const std::string &warning : finding.warnings) ROS_WARN_STREAM_NAMED(ADAPTER_LOG, warning);
    for (const Doubt &doubt : finding.doubts) violations_.publish(toMessage(doubt));
    markers_.publish(toMarkers(finding.doubts, scene.getPlanningFrame()));
  }

  /* Replaces the plan by a beginning of it that is timed anew, ends at rest and is proven. false: there is none. */
  bool shrink(const planning_scene::PlanningScene &scene, const MotionPlanRequest &req, const Finding &finding,
              MotionPlanResponse &res) const {
    const Trajectory &whole = *res.trajectory_;
    for (int parts = SHRINK_STEPS; parts > 0 && finding.clear_until > 0.0; --parts) {
      const double end = finding.clear_until * parts / SHRINK_STEPS;
      const robot_trajectory::RobotTrajectoryPtr shorter = upTo(whole, end);
      if (!trajectory_processing::IterativeParabolicTimeParameterization().computeTimeStamps(
              *shorter, req.max_velocity_scaling_factor, req.max_acceleration_scaling_factor))
        return false;
      if (!certifier_.judge(scene, *shorter, settings_).why.empty()) continue;
      ROS_WARN_STREAM_NAMED(ADAPTER_LOG, finding.why << ": the plan is shortened, it ends where it was at t = " << end
                                                     << " of " << whole.getDuration() << " s");
      res.trajectory_ = shorter;
      return true;
    }
    return false;
  }

  CertifySettings settings_;
  double repair_ms_ = 0.0; /* 0: no plan is repaired */
  int attempts_ = 3;
  bool reject_ = true, shrink_ = false;
  Certifier certifier_;
  ros::Publisher violations_, markers_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::CertifyTrajectory, planning_request_adapter::PlanningRequestAdapter)
