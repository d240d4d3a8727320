/* SPDX-License-Identifier: BSD-3-Clause */
/** Planar and floating joints by the poses that multi-DOF messages and files give them. */
#ifndef CURVE_PROXIMITY_SCENE_FREE_JOINTS_H
#define CURVE_PROXIMITY_SCENE_FREE_JOINTS_H

#include <optional>
#include <string>
#include <vector>

#include <curve_proximity/robot.hpp>
#include <curve_proximity/srdf.hpp>
#include <curve_proximity/trajectory.hpp>

namespace curve_proximity {

/** A joint whose transform is a pose. */
struct FreeJoint {
  std::string name;
  bool planar = false; /**< else floating */
  std::string parent;  /**< the frame that its poses are in */
  bool is_virtual = false;
  bool flat = true; /**< its plane is that of x and y */
};

/** A planar or floating joint of that name among the virtual joints, or of the robot. */
std::optional<FreeJoint> findFreeJoint(const std::string &name, const Robot &robot,
                                       const std::vector<VirtualJoint> &virtual_joints);

/** The names of its variables: NAME/x … */
std::vector<std::string> variablesOf(const FreeJoint &joint);

/** The unit quaternion of a pose, on the side of the one before it. Throws Error, which begins with `where`, for a norm
 *  that is 0 or not finite. */
Eigen::Quaterniond rotationOf(const cprox_pose &pose, const std::string &where, const Eigen::Quaterniond &before);

/** The values of its variables at each pose (planar: 3, floating: 7): angles without jumps, quaternions of norm 1 on
 * the side of the one before. Throws Error, which names the pose: not finite, a quaternion of norm 0, a pose out of a
 *  planar joint's plane, or of a joint that is not flat. */
std::vector<std::vector<double>> valuesAt(const std::vector<cprox_pose> &poses, const FreeJoint &joint);

/** The same, of the poses that a file or a message gives a joint; none where it leaves it at the identity and there is
 *  no such joint. Throws Error: no such joint, a fixed one, poses in another frame than the joint's. */
std::optional<FreeJoint> resolveFreeJoint(const FreeJointPoses &given, const Robot &robot,
                                          const std::vector<VirtualJoint> &virtual_joints);

} // namespace curve_proximity
#endif
