/* SPDX-License-Identifier: BSD-3-Clause */
#include "repair.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>

#include <moveit/trajectory_processing/iterative_time_parameterization.h>
#include <moveit/utils/message_checks.h>
#include <ros/console.h>

namespace curve_proximity {
namespace {

using Clock = std::chrono::steady_clock;
using moveit::core::JointModel;
using robot_trajectory::RobotTrajectory;
using robot_trajectory::RobotTrajectoryPtr;

/* [m] more than the clearance asked for, of new edges from objects: the first for which there is a way. */
constexpr double MARGINS[] = {0.01, 0.003, 0.001, 0.0};

/* The spline goes beside the straight edges: what is tried until it is proven. */
struct Try {
  double stays; /* [m] more than the clearance asked for, of edges that stay as they are, and of all from the robot
                 * itself: links side by side are always close */
  int halvings; /* of edges: the spline comes closer to them */
};
constexpr Try TRIES[] = {{0.0, 0}, {0.0, 1}, {0.001, 0}, {0.001, 1}, {0.003, 1}, {0.003, 2}};

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
  const moveit::core::JointModelGroup *group = trajectory.getGroup();
  if (!group || !isPlain(*group) || !moveit::core::isEmpty(req.path_constraints)) return nullptr;
  const TrajectoryDescription spline = timed(trajectory);
  Path path;
  for (const TrajectoryPoint &point : spline.points) path.push_back(point.positions);
  const double step = path.size() > 1 ? lengthOf(path) / static_cast<double>(path.size() - 1) : 0.0;
  if (!(step > 0.0)) return nullptr;

  bool with_self = why.of_self;
  double of_self = 0.0;                                    // what new edges keep from the robot itself
  std::map<std::pair<RobotPairs, double>, EdgeTest> known; // each is made when it is first asked
  const auto holds = [&](RobotPairs against, double more, const Row &from, const Row &to) {
    EdgeTest &test = known[{against, more}];
    if (!test) {
      CertifySettings wider = settings;
      wider.clearance += more;
      test = certifier.edges(scene, trajectory.getFirstWayPoint(), spline.joints, against, wider);
    }
    return test(from, to);
  };
  const auto edges = [&](double more) -> EdgeTest {
    return [&, more](const Row &from, const Row &to) {
      return holds(RobotPairs::ENVIRONMENT, more, from, to) &&
             (!with_self || holds(RobotPairs::SELF, std::min(more, of_self), from, to));
    };
  };
  for (const Row &row : {path.front(), path.back()})
    if (!edges(0.0)(row, row)) return nullptr; // no way round leads there
  const JointBox limits = limitsOf(*trajectory.getRobotModel(), spline.joints);
  const auto is_over = [end = Clock::now() + std::chrono::microseconds(std::llround(1e3 * budget_ms))] {
    return Clock::now() >= end;
  };
  for (const Try &one : TRIES) {
    of_self = one.stays;
    Detours detours{edges(one.stays), {}, edges(0.0), limits, step, is_over};
    for (const double margin : MARGINS)
      if (margin >= one.stays) detours.wanted.push_back(edges(margin));
    Path way = around(path, detours);
    if (is_over()) return nullptr;
    if (way.empty()) continue;
    for (int k = 0; k < one.halvings; ++k) way = halved(way);
    const RobotTrajectoryPtr out = toTrajectory(way, spline.joints, trajectory);
    if (!trajectory_processing::IterativeParabolicTimeParameterization().computeTimeStamps(
            *out, req.max_velocity_scaling_factor, req.max_acceleration_scaling_factor))
      return nullptr;
    const Finding finding = certifier.judge(scene, *out, settings);
    if (finding.why.empty()) return out;
    with_self = with_self || finding.of_self;
  }
  return nullptr;
} catch (const std::exception &error) {
  ROS_DEBUG_STREAM_NAMED("certify_trajectory", "the plan cannot be repaired: " << error.what());
  return nullptr;
}

} // namespace curve_proximity
