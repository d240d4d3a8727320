/* SPDX-License-Identifier: BSD-3-Clause */
/** Between ROS messages and the plain descriptions of the scene, both ways. Needs no node and no master. */
#ifndef CURVE_PROXIMITY_ROS_CONVERSIONS_H
#define CURVE_PROXIMITY_ROS_CONVERSIONS_H

#include <curve_proximity/AllowedContact.h>
#include <curve_proximity/ApplyScene.h>
#include <curve_proximity/AttachedCollisionObject.h>
#include <curve_proximity/CollisionObject.h>
#include <curve_proximity/Curve.h>
#include <curve_proximity/GetScene.h>
#include <curve_proximity/LinkPadding.h>
#include <curve_proximity/LinkScale.h>
#include <curve_proximity/PairQuery.h>
#include <curve_proximity/Profile.h>
#include <curve_proximity/Proximity.h>
#include <curve_proximity/ViolationIntervals.h>
#include <geometry_msgs/Pose.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <curve_proximity/query.hpp>
#include <curve_proximity/scene.hpp>
#include <curve_proximity/trajectory.hpp>
#include <functional>
#include <string>
#include <vector>

#include "../scene/pair_query.h"

namespace curve_proximity {

/** Throws Error for a quaternion of norm 0 or a number that is not finite. */
Eigen::Isometry3d toIsometry(const geometry_msgs::Pose &pose);
geometry_msgs::Pose toMessage(const Eigen::Isometry3d &pose);

geometry_msgs::Point toPointMessage(const cprox_vec3 &point);

/** A curve with its points brought to the fixed frame. An empty parameter range becomes the whole of the curve.
 *  What is wrong with the curve itself is left to compile(). */
CurveDescription toDescription(const Curve &curve, const Eigen::Isometry3d &frame_in_fixed);
/** The same in the memory of another description. */
void toDescription(const Curve &curve, const Eigen::Isometry3d &frame_in_fixed, CurveDescription &out);

/** One operation on the scene; its object's pose is still the message's, in header.frame_id.
 *  Throws Error, which names the object and the shape: an unknown type or operation, poses that do not match the
 * shapes, triangles with an index that is none. Dimensions are left to the scene. */
Operation toOperation(const CollisionObject &object);

/** A pair as ~measure_pairs takes it. Throws Error: an unknown question, a velocity or duration of bodies that stand.
 */
PairDescription toDescription(const PairQuery &message);

/** The whole request of ~apply_scene. The poses of objects are brought to the fixed frame by `to_fixed(header)`, which
 * may throw. An object that cannot be converted becomes a sentence in `faults`, and the others stay. */
using ToFixed = std::function<Eigen::Isometry3d(const std_msgs::Header &header)>;
SceneChange toSceneChange(const ApplySceneRequest &request, const ToFixed &to_fixed, std::vector<std::string> &faults);

/** What links are to carry, the same way. `before`: the scene that the attachments are for, since what is detached must
 * be known to stand on its link. */
using LinkToFixed = std::function<Eigen::Isometry3d(const std::string &link, const ros::Time &stamp)>;
void addAttachments(const ApplySceneRequest &request, const ToFixed &to_fixed, const LinkToFixed &link_to_fixed,
                    const Snapshot &before, SceneChange &change, std::vector<std::string> &faults);

/** An object as ~apply_scene would take it with operation ADD. Mesh files stay names of files. */
CollisionObject toMessage(const ObjectDescription &object);

/** The scene as ~get_scene gives it, in full or the named objects. Throws Error for a name that is not there. */
void toMessage(const Snapshot &snapshot, const std::vector<std::string> &ids, GetSceneResponse &response);

/** A change as ~apply_scene takes it: the way of a scene file to the node. The poses are in object.frame. */
ApplySceneRequest toMessage(const SceneChange &change);

/** Fills one row of the results, which is as it was made. What has no answer has NaN for numbers. */
void fillRow(const Answer &answer, QueryType query_type, Proximity &message);

/** [s] of a start; infinity: any time. Throws Error for a tolerance below 0. */
double toStartTolerance(double tolerance, bool any_time);

/** The intervals of what the summary is about, without that. */
ViolationIntervals toMessage(const Violations &violations);

/** The profile of what the summary is about, without that. */
Profile toMessage(const std::vector<ClearanceInterval> &intervals);

/** The row of a curve or motion that could not be asked about. */
Proximity toFailedRow(const std::string &id, const std::string &kind, const std::string &why);

/** Throws Error where names and positions are not as many, or a joint is named twice. */
JointPositions toJointPositions(const sensor_msgs::JointState &state);

/** A joint trajectory. Where its first point comes after 0 and `now` has all of its joints, it begins at 0 with the way
 *  from there: at rest if that point has velocities, without acceleration if it has accelerations. Times that are all 0
 *  become 0, 1, 2 …, and `remark` says so. A point that repeats the one before it, time included, is left out. */
TrajectoryDescription toDescription(const trajectory_msgs::JointTrajectory &trajectory, const JointPositions &now,
                                    std::string &remark);

} // namespace curve_proximity
#endif
