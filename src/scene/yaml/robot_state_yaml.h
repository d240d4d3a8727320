/* SPDX-License-Identifier: BSD-3-Clause */
/** The joints of a moveit_msgs/RobotState. */
#ifndef CURVE_PROXIMITY_YAML_ROBOT_STATE_YAML_H
#define CURVE_PROXIMITY_YAML_ROBOT_STATE_YAML_H

#include <vector>

#include <curve_proximity/robot.hpp>
#include <curve_proximity/trajectory.hpp>

#include "yaml_value.h"

namespace curve_proximity::yaml {

/** Where the joints stand. */
struct JointsFile {
  JointPositions joints;                   /**< joint_state */
  std::vector<FreeJointPoses> free_joints; /**< multi_dof_joint_state: each with one pose */
};

/** The values under joint_state and multi_dof_joint_state of a robot's state; both may be absent. Throws BadInput: a
 *  joint twice, lists of different length, a pose that is none. */
JointsFile readJoints(const YamlValue &state, Warnings &warnings);

/** header.frame_id of a value; empty where it has none. */
std::string readFrame(const YamlValue &value, Warnings &warnings);

/** The list `transforms` of a value; quaternions as they stand. */
std::vector<cprox_pose> readTransforms(const YamlValue &value, Warnings &warnings);

} // namespace curve_proximity::yaml
#endif
