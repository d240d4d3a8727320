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

/** A planar or floating joint by its poses, as trajectory_msgs/MultiDOFJointTrajectory and
 * sensor_msgs/MultiDOFJointState have it. */
struct FreeJointPoses {
  std::string joint;             /**< of the robot, or a virtual joint of its SRDF */
  std::string frame;             /**< that the poses are in: the joint's parent; empty: the same */
  std::vector<cprox_pose> poses; /**< one a point; or a single one: it stands there */
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

  /** Further joints, by their poses at the points. adoptBase() turns them into values of their variables; a RobotMotion
   *  refuses those that are left. */
  std::vector<FreeJointPoses> free_joints;
  /** Continuous joints, and the angle of planar ones, turn the shorter way from waypoint to waypoint; otherwise they
   * turn as their values say, from 3.1 to -3.1 by 6.2 rad. */
  bool shortest_way = false;
  /** Objects that links carry when the motion begins. A RobotMotion refuses those that its scene does not attach. */
  std::vector<std::string> carried;
};

/** Makes the trajectory one of this robot, whose SRDF has these virtual joints. The poses of free_joints become values
 * of their variables: of a joint that stands in fixed_joints, else at the points, with all joints going straight from
 * point to point. If the trajectory names variables of a virtual joint (NAME/x …) and has no base, that joint becomes
 * its base. Throws Error: a joint that is not at the identity and that the robot does not have, poses in another frame
 * than the joint's, poses that leave a planar joint's plane. */
void adoptBase(const std::vector<VirtualJoint> &joints, const Robot &robot, TrajectoryDescription &trajectory);

/** Where the base stands that a scene's robot_state puts at `base`: the place of a trajectory without a base; else that
 * is the identity, and the values of the base's variables go to `rest`, for those that the trajectory does not name. */
Eigen::Isometry3d placeOf(const TrajectoryDescription &trajectory, const Eigen::Isometry3d &base, JointPositions &rest);

/** A warning for each continuous joint, and each planar joint's angle, that turns by more than half a turn between two
 *  waypoints: a planner's states mean the short way, and the trajectory goes the long one. None of splines, and none
 * with shortest_way. RobotMotion::warnings() has them. */
std::vector<std::string> longWays(const Robot &robot, const TrajectoryDescription &trajectory);

/** Checks a trajectory. Throws Error for missing joints or points, a name twice, counts that differ, numbers that are
 *  not finite, times that do not ascend, and missing velocities or accelerations. The message names point and joint. */
void checkTrajectory(const TrajectoryDescription &trajectory);

} // namespace curve_proximity
#endif
