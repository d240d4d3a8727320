/* SPDX-License-Identifier: BSD-3-Clause */
/** Frames of a scene file: from their names to poses in the fixed frame. */
#ifndef CURVE_PROXIMITY_YAML_SCENE_FRAMES_H
#define CURVE_PROXIMITY_YAML_SCENE_FRAMES_H

#include <map>
#include <set>
#include <string>
#include <vector>

#include <curve_proximity/robot.hpp>

#include "scene_yaml.h"

namespace curve_proximity::yaml {

class Frames {
 public:
  /** fixed       names of the fixed frame beside '' and 'world': the root link, the SRDF's parent frame.
   *  transforms  come next; warnings tell of those that would move the fixed frame, which stays.
   *  links       where the robot's links are at the scene's robot_state: they come last. */
  Frames(std::set<std::string> fixed, const std::vector<FrameTransform> &transforms, LinkPoses links,
         Warnings &warnings);

  /** The pose of a frame in the fixed frame; a slash in front of the name is left out. Throws BadInput, naming the
   *  frame, where it is not known or stands, in the end, in itself. */
  Eigen::Isometry3d find(const std::string &name) const;

  bool isFixed(const std::string &name) const;
  bool knows(const std::string &name) const;

 private:
  std::set<std::string> fixed_;
  std::map<std::string, FrameTransform> transforms_; /* by child */
  LinkPoses links_;
};

} // namespace curve_proximity::yaml
#endif
