/* SPDX-License-Identifier: BSD-3-Clause */
/** A joint trajectory as plain data, from trajectory_msgs/JointTrajectory or from a YAML file. */
#ifndef CURVE_PROXIMITY_TRAJECTORY_HPP
#define CURVE_PROXIMITY_TRAJECTORY_HPP

#include <string>
#include <vector>

#include <curve_proximity/coverage.hpp>
#include <curve_proximity/robot.hpp>
#include <curve_proximity/srdf.hpp>

namespace curve_proximity {

/** The interpolation between two points, as in joint_trajectory_controller. */
enum class Interpolation {
  BY_POINTS, /**< by the data of both points: positions: linear; velocities too: cubic; accelerations too: quintic */
  LINEAR,    /**< positions */
  CUBIC,     /**< positions and velocities */
  QUINTIC    /**< positions, velocities and accelerations */
};

/** A waypoint. */
struct TrajectoryPoint {
  std::vector<double> positions;     /**< [rad] or [m], one a joint */
  std::vector<double> velocities;    /**< one a joint, or empty */
  std::vector<double> accelerations; /**< one a joint, or empty */
  double time = 0.0;                 /**< [s] from the start, ascending */
};

/** Waypoints of named joints. */
struct TrajectoryDescription {
  std::string id;                                         /**< names the trajectory in results */
  std::vector<std::string> joints;                        /**< the joints that move */
  std::vector<TrajectoryPoint> points;                    /**< at least one */
  Interpolation interpolation = Interpolation::BY_POINTS; /**< between the points */
  /** 0: waypoints. 1 … 9: the trajectory is a B-spline of this degree with the points' positions as control points;
   *  their times, velocities and accelerations, and `interpolation`, are not read. */
  std::size_t degree = 0;
  std::vector<double> knots; /**< [s] of the B-spline: points.size() + degree + 1, non-decreasing */

  JointPositions fixed_joints;    /**< joints with a constant value */
  std::vector<VirtualJoint> base; /**< the joint above the root link, if the trajectory names it: none or one */
  /** The names of the base joint's variables (planar: x, y, theta; floating: x, y, z and the quaternion's x, y, z, w).
   *  Empty: MoveIt's names, NAME/x … */
  std::vector<std::string> base_joints;
  Coverage coverage; /**< what of its source is not used: no answer along it is then 'clear' */
};

/** If the trajectory names variables of one of these joints (NAME/x …) and has no base, that joint becomes its base. */
void adoptBase(const std::vector<VirtualJoint> &joints, TrajectoryDescription &trajectory);

/** Checks a trajectory. Throws Error for missing joints or points, a name twice, counts that differ, numbers that are
 *  not finite, times that do not ascend, and missing velocities or accelerations. The message names point and joint. */
void checkTrajectory(const TrajectoryDescription &trajectory);

} // namespace curve_proximity
#endif
