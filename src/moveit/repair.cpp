/* SPDX-License-Identifier: BSD-3-Clause */
#include "repair.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <moveit/trajectory_processing/iterative_time_parameterization.h>
#include <moveit/utils/message_checks.h>
#include <ros/console.h>

namespace curve_proximity {
namespace {

using Clock = std::chrono::steady_clock;
using moveit::core::JointModel;
using robot_trajectory::RobotTrajectory;
using robot_trajectory::RobotTrajectoryPtr;

/* [m] more than the clearance asked for, and the part of the time after which the next one is tried. */
constexpr std::pair<double, double> MARGINS[] = {{0.01, 0.4}, {0.003, 0.7}, {0.0, 1.0}};
constexpr int CLOSER[] = {1, 2, 4}; /* times as many waypoints */

/* The group's joints have one value each, and follow no other. */
bool isPlain(const moveit::core::JointModelGroup &group) {
  const std::vector<const JointModel *> &joints = group.getActiveJointModels();
  return std::all_of(joints.begin(), joints.end(),
                     [](const JointModel *joint) { return joint->getVariableCount() == 1 && !joint->getMimic(); });
}

/* Joints that go round have no limits. */
JointBox limitsOf(const moveit::core::RobotModel &model, const std::vector<std::string> &joints) {
  constexpr double INFINITE = std::numeric_limits<double>::infinity();
  JointBox out;
  for (const std::string &joint : joints) {
    const moveit::core::VariableBounds &bounds = model.getVariableBounds(joint);
    out.lower.push_back(bounds.position_bounded_ ? bounds.min_position_ : -INFINITE);
    out.upper.push_back(bounds.position_bounded_ ? bounds.max_position_ : INFINITE);
  }
  return out;
}

/* Without times; the ends are those of the trajectory. */
RobotTrajectoryPtr toTrajectory(const Path &path, const std::vector<std::string> &joints,
                                const RobotTrajectory &trajectory) {
  auto out = std::make_shared<RobotTrajectory>(trajectory.getRobotModel(), trajectory.getGroup());
  out->addSuffixWayPoint(trajectory.getFirstWayPoint(), 0.0);
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    moveit::core::RobotState state(trajectory.getFirstWayPoint());
    for (std::size_t k = 0; k < joints.size(); ++k) state.setVariablePosition(joints[k], path[i][k]);
    state.enforceBounds(trajectory.getGroup());
    state.update();
    out->addSuffixWayPoint(state, 0.0);
  }
  out->addSuffixWayPoint(trajectory.getLastWayPoint(), 0.0);
  return out;
}

} // namespace

RobotTrajectoryPtr repaired(const Certifier &certifier, const planning_scene::PlanningScene &scene,
                            const planning_interface::MotionPlanRequest &req, const RobotTrajectory &trajectory,
                            const Finding &why, const CertifySettings &settings, double budget_ms) try {
  const Clock::time_point begin = Clock::now();
  const auto end_of = [&](double share) {
    return begin + std::chrono::microseconds(std::llround(1e3 * share * budget_ms));
  };
  const moveit::core::JointModelGroup *group = trajectory.getGroup();
  if (!group || !isPlain(*group) || !moveit::core::isEmpty(req.path_constraints)) return nullptr;
  const TrajectoryDescription spline = timed(trajectory);
  Path path;
  for (const TrajectoryPoint &point : spline.points) path.push_back(point.positions);
  const double step = path.size() > 1 ? lengthOf(path) / static_cast<double>(path.size() - 1) : 0.0;
  if (!(step > 0.0)) return nullptr;

  bool with_self = why.of_self;
  const JointBox limits = limitsOf(*trajectory.getRobotModel(), spline.joints);
  const auto edges = [&](double more) {
    CertifySettings wider = settings;
    wider.clearance += more;
    return certifier.edges(scene, trajectory.getFirstWayPoint(), spline.joints, with_self, wider);
  };
  const EdgeTest as_asked = edges(0.0);
  for (const Row &row : {path.front(), path.back()})
    if (!as_asked(row, row)) return nullptr; // no way round leads there
  for (const auto &[margin, share] : MARGINS) {
    const Clock::time_point end = end_of(share);
    const Path way = around(path, {edges(margin), edges(0.0), limits, [end] { return Clock::now() >= end; }});
    if (way.empty()) continue;
    for (const int closer : CLOSER) {
      if (Clock::now() >= end_of(1.0)) return nullptr;
      const RobotTrajectoryPtr out = toTrajectory(resampled(way, step / closer), spline.joints, trajectory);
      if (!trajectory_processing::IterativeParabolicTimeParameterization().computeTimeStamps(
              *out, req.max_velocity_scaling_factor, req.max_acceleration_scaling_factor))
        return nullptr;
      const Finding finding = certifier.judge(scene, *out, settings);
      if (finding.why.empty()) return out;
      with_self = with_self || finding.of_self;
    }
  }
  return nullptr;
} catch (const std::exception &error) {
  ROS_DEBUG_STREAM_NAMED("certify_trajectory", "the plan cannot be repaired: " << error.what());
  return nullptr;
}

} // namespace curve_proximity
