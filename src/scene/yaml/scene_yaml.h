/* SPDX-License-Identifier: BSD-3-Clause */
/** SCENE.yaml: the shape of moveit_msgs/PlanningScene. */
#ifndef CURVE_PROXIMITY_YAML_SCENE_YAML_H
#define CURVE_PROXIMITY_YAML_SCENE_YAML_H

#include <map>
#include <string>
#include <vector>

#include <curve_proximity/files.hpp>
#include <curve_proximity/robot.hpp>
#include <curve_proximity/scene.hpp>

#include "yaml_value.h"

namespace curve_proximity::yaml {

/** An entry of fixed_frame_transforms: where the frame `child` stands in `parent`. */
struct FrameTransform {
  std::string parent, child;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

/** The file as it stands: poses are still in the frames that the objects name. */
struct SceneFile {
  std::string robot;                 /**< robot_model_name; may be empty */
  bool is_diff = false;              /**< true: adds to the scene that is there; false: replaces it */
  std::vector<Operation> operations; /**< the collision objects, in order */
  std::vector<Attachment> attached;  /**< their poses in the frames that the objects name, as all others */
  std::vector<FrameTransform> transforms;
  JointPositions joints;                   /**< robot_state */
  std::vector<FreeJointPoses> free_joints; /**< robot_state: planar and floating joints, each with one pose */
  std::map<std::string, double> link_padding, link_scale;
  std::vector<AllowedPair> allowed;
  std::vector<MovingRobotFile> moving_robots;
  Coverage coverage; /**< what of the file is not used */
};

/** The frame, pose, padding and shapes of an object, in the words of a collision object; each may be missing. */
ObjectDescription readPlacedShapes(const YamlValue &object, Warnings &warnings);

/** Reads a scene. Throws BadUsage naming the file, the place and the line: anything that would leave an object out or
 *  put it elsewhere. What can be ignored is ignored with a warning. */
SceneFile readScene(const std::string &path, Warnings &warnings);

} // namespace curve_proximity::yaml
#endif
