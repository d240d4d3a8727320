/* SPDX-License-Identifier: BSD-3-Clause */
/** How far along a joint trajectory a robot is, by the positions of its joints. */
#ifndef CURVE_PROXIMITY_ROS_TRAJECTORY_PROGRESS_H
#define CURVE_PROXIMITY_ROS_TRAJECTORY_PROGRESS_H

#include <trajectory_msgs/JointTrajectory.h>

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace curve_proximity {

/** The joints of a URDF that a full turn brings to the same place. Throws Error where it cannot be read. */
std::set<std::string> continuousJoints(const std::string &urdf);

/** The clock does not tell where a robot is: it may run at a part of its speed. Between two points of the trajectory
 * each joint stays in the range of the Bézier points of the cubic or quintic there, or of the line where the points
 * have no velocities. The robot is taken to be in the first segment whose ranges, widened by the tolerance, hold its
 * joints. So what is left of the trajectory is never taken to be less than it is. */
class TrajectoryProgress {
 public:
  /** tolerance [rad, m]: how far each joint may be from the trajectory, > 0. continuous: joints that a full turn brings
   *  to the same place; any other joint has to turn back. */
  TrajectoryProgress(trajectory_msgs::JointTrajectory trajectory, double tolerance,
                     const std::set<std::string> &continuous = {});

  const trajectory_msgs::JointTrajectory &trajectory() const {
    return trajectory_;
  }

  /** What the joints are `elapsed` seconds after what was told last; other joints may be among them. A robot is at most
   *  as fast as the trajectory. Returns "" or why that is no place on what is left: a joint is missing or elsewhere. */
  std::string tell(const std::vector<std::string> &names, const std::vector<double> &positions, double elapsed);

  /** The robot is not before this point: the segment from it to the next is the first on which it may be. */
  std::size_t point() const {
    return point_;
  }

  /** It was within the tolerance of the last point when it was last told. */
  bool isAtEnd() const {
    return at_end_;
  }

 private:
  double deviation(std::size_t point, const std::vector<double> &joints, std::size_t &worst) const;

  trajectory_msgs::JointTrajectory trajectory_;
  double tolerance_;
  std::vector<bool> continuous_; /* of each joint */
  std::size_t point_ = 0;
  double latest_ = 0.0; /* [s] of the trajectory: it is not farther than this, but for a message's way */
  bool at_end_ = false;
};

} // namespace curve_proximity
#endif
