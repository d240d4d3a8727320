/* SPDX-License-Identifier: BSD-3-Clause */
/** From a scene file to what a live scene is told: the way of `cprox send` and of ~scene_file. */
#ifndef CURVE_PROXIMITY_YAML_SCENE_CHANGE_H
#define CURVE_PROXIMITY_YAML_SCENE_CHANGE_H

#include <set>
#include <string>

#include "scene_frames.h"
#include "scene_yaml.h"

namespace curve_proximity::yaml {

/** The folder that a file lies in. */
std::string folderOf(const std::string &path);

/** The file at `path` as a change. Frames that the file itself explains are resolved; others stay in object.frame, for
 * tf2 to resolve. Mesh files get absolute paths. A file that is no diff (is_diff) replaces the scene: the change clears
 * it. Throws BadUsage naming file and object where the file's frames go in a ring, and where a part of the file would
 * be left out. */
SceneChange toChange(const SceneFile &file, const std::string &path, Warnings &warnings);

/** Paths of mesh files that are relative become those below the folder. */
void makeResourcesAbsolute(SceneChange &change, const std::string &folder);

/** Where a scene file's robot_state puts a robot. */
struct RobotPlace {
  JointPositions joints;                                  /**< of the joints that the robot has */
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity(); /**< of its root link in the fixed frame */
  LinkPoses links;                                        /**< by both */
  std::set<std::string> fixed;                            /**< names that the fixed frame has because of the robot */
};

/** The file's robot_state, without the joints that this robot does not have: a warning names those. virtual_joints: of
 *  its SRDF. Throws Error: a planar or floating joint that is moved and that the robot does not have, or in another
 *  frame than its own; values that are none. */
RobotPlace placeRobot(const SceneFile &file, const Robot &robot, const std::vector<VirtualJoint> &virtual_joints,
                      Warnings &warnings);

/** All that the file says, in the fixed frame. robot may be null: what is attached then stands where it is. links:
 * where the robot's links are at the file's robot_state. Throws BadUsage naming the object: a frame or a link that is
 * not known. */
SceneChange toFixedChange(const SceneFile &file, const Frames &frames, const Robot *robot, const LinkPoses &links,
                          Warnings &warnings);

} // namespace curve_proximity::yaml
#endif
