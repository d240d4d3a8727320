/* SPDX-License-Identifier: BSD-3-Clause */
/** What comes by topic in a type that is not ours, as what the queries take. */
#ifndef CURVE_PROXIMITY_ROS_TOPICS_H
#define CURVE_PROXIMITY_ROS_TOPICS_H

#include <curve_proximity/Curve.h>
#include <nav_msgs/Path.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <curve_proximity/description.hpp>
#include <curve_proximity/robot.hpp>
#include <curve_proximity/srdf.hpp>
#include <vector>

namespace curve_proximity {

/** The natural cubic spline through points at ascending parameters, as a B-spline of degree 3: its second derivative is
 *  continuous, and 0 at both ends (C. de Boor, A Practical Guide to Splines, ch. IV). As many points as parameters, at
 * least two; fills basis, degree, points and knots. */
void fitNaturalSpline(const std::vector<geometry_msgs::Point> &points, const std::vector<double> &at, Curve &curve);

/** A path as the natural cubic spline through its poses' positions, over the length of the chords between them [m].
 * Poses that repeat the position before them are left out; a path of one position is that point. The curve's id is
 * "path". Throws Error: no poses, a position that is not finite, a pose in another frame than the path's. */
Curve toCurve(const nav_msgs::Path &path, double radius);

/** What rides along a path, in the path's frame. */
struct PathPoses {
  std::vector<TimedPose> poses;
  ros::Time stamp;    /**< of time 0; zero: none */
  std::string remark; /**< what a reader should know of the times; empty: nothing */
};

/** At the stamps of the poses: the first one's is 0. Where these do not ascend, pose i is at i, and the remark says so.
 *  Throws Error: no poses, one that is no pose, or in another frame than the path's. */
PathPoses toPoses(const nav_msgs::Path &path);

/** The same of what a joint of a trajectory moves that is no robot's, by its number. Throws Error also for times that
 *  do not ascend, and for counts that differ. */
std::vector<TimedPose> toPoses(const trajectory_msgs::MultiDOFJointTrajectory &trajectory, std::size_t joint);

/** Is it about planar or floating joints of the robot? robot: may be null. */
bool movesRobot(const trajectory_msgs::MultiDOFJointTrajectory &trajectory, const Robot *robot, const Srdf &srdf);

/** A trajectory of planar and floating joints, as the joint trajectory of their parts (NAME/x …, NAME/trans_x …):
 * linear between the points; velocities and accelerations are not looked at. Angles and quaternions take the shorter
 * way from point to point. Throws Error, naming joint and point: a joint that is not the robot's, a transform that
 * leaves the plane of a planar joint, a count of transforms that differs from that of the joints, numbers that are not
 * finite, a frame that is not the joint's parent.
 */
trajectory_msgs::JointTrajectory toJointTrajectory(const trajectory_msgs::MultiDOFJointTrajectory &trajectory,
                                                   const Robot &robot, const Srdf &srdf);

/** Of what is no robot's: each joint's translation as the natural cubic spline through its points over time [s], id the
 * joint's name. Throws Error: no joints, fewer than two points, times that do not ascend, counts that differ. */
std::vector<Curve> toCurves(const trajectory_msgs::MultiDOFJointTrajectory &trajectory, double radius);

} // namespace curve_proximity
#endif
