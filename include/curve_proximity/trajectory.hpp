/* SPDX-License-Identifier: BSD-3-Clause */
/** A joint trajectory as plain data: the common language of trajectory_msgs/JointTrajectory and of T.yaml. */
#ifndef CURVE_PROXIMITY_TRAJECTORY_HPP
#define CURVE_PROXIMITY_TRAJECTORY_HPP

#include <string>
#include <vector>

#include <curve_proximity/robot.hpp>
#include <curve_proximity/srdf.hpp>

namespace curve_proximity {

/** How the joints move between two points: as joint_trajectory_controller does. */
enum class Interpolation {
  /** by what both points of a segment carry: positions only: linear; velocities too: cubic; accelerations too:
   *  quintic */
  BY_POINTS,
  LINEAR,
  CUBIC,
  QUINTIC
};

struct TrajectoryPoint {
  std::vector<double> positions;                 /**< radians or metres, one a joint */
  std::vector<double> velocities, accelerations; /**< one a joint, or none at all */
  double time = 0.0;                             /**< seconds from the start, ascending */
};

struct TrajectoryDescription {
  std::string id;
  std::vector<std::string> joints;
  std::vector<TrajectoryPoint> points;
  Interpolation interpolation = Interpolation::BY_POINTS;

  JointPositions fixed_joints;    /**< joints that stand still at a value of their own */
  std::vector<VirtualJoint> base; /**< the joint above the root link, where the trajectory names it: none or one */
  /** the names of its parts (planar: x, y, theta; floating: x, y, z and the quaternion's x, y, z, w); empty: as
   *  MoveIt names them, NAME/x … */
  std::vector<std::string> base_joints;
};

/** Gives a trajectory that names parts of one of these joints (NAME/x …) and no base of its own that joint as its
 *  base. */
void adoptBase(const std::vector<VirtualJoint> &joints, TrajectoryDescription &trajectory);

/** Throws Error, naming point and joint: no joints or points, a name twice, counts that differ, numbers that are not
 *  finite, times that do not ascend, an interpolation for which points lack velocities or accelerations. */
void checkTrajectory(const TrajectoryDescription &trajectory);

} // namespace curve_proximity
#endif
