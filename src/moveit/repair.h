/* SPDX-License-Identifier: BSD-3-Clause */
/* A plan that is not proven is led round what it hits. */
#ifndef CURVE_PROXIMITY_MOVEIT_REPAIR_H
#define CURVE_PROXIMITY_MOVEIT_REPAIR_H

#include <moveit/planning_interface/planning_request.h>

#include "certifier.h"

namespace curve_proximity {

/* A trajectory with the same first and last waypoint that is proven, found within `budget_ms`; nullptr: there is none.
 * `why`: what judge() has found. Straight motions between waypoints that are not proven are replaced by a way round,
 * with some clearance more than asked if there is room: the spline leaves the straight motions at corners. Where that
 * is too far, waypoints stand closer. Timed by MoveIt's IterativeParabolicTimeParameterization. */
robot_trajectory::RobotTrajectoryPtr repaired(const Certifier &certifier, const planning_scene::PlanningScene &scene,
                                              const planning_interface::MotionPlanRequest &req,
                                              const robot_trajectory::RobotTrajectory &trajectory, const Finding &why,
                                              const CertifySettings &settings, double budget_ms);

} // namespace curve_proximity
#endif
