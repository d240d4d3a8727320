/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/files.hpp>

#include "failure.h"
#include "scene_change.h"
#include "trajectory_yaml.h"

namespace curve_proximity {

SceneFileContents loadSceneFile(const std::string &path, const Robot *robot, const Srdf &srdf) {
  using namespace yaml;
  SceneFileContents out;
  Warnings warnings;
  try {
    const SceneFile file = readScene(path, warnings);
    LinkPoses links;
    std::set<std::string> fixed;
    if (robot) {
      out.joints = jointsOf(file, *robot, warnings);
      links = robot->linkPoses(out.joints);
      fixed.insert(robot->rootLink());
      if (!srdf.virtual_joints.empty()) fixed.insert(srdf.virtual_joints.front().parent_frame);
    }
    const Frames frames(fixed, file.transforms, links, warnings);
    try {
      out.change = toFixedChange(file, frames, robot, links, warnings);
    } catch (const BadUsage &e) {
      throw Error(path + ": " + e.what());
    }
    makeResourcesAbsolute(out.change, folderOf(path));
    out.moving_robots = file.moving_robots;
    out.change.clear = !file.is_diff;
  } catch (const BadUsage &e) {
    throw Error(e.what());
  }
  out.warnings = warnings.sentences();
  return out;
}

TrajectoryDescription loadTrajectoryFile(const std::string &path, std::vector<std::string> *warnings) {
  yaml::Warnings heard;
  try {
    TrajectoryDescription out = yaml::readTrajectory(path, heard);
    if (warnings) warnings->insert(warnings->end(), heard.sentences().begin(), heard.sentences().end());
    return out;
  } catch (const yaml::BadUsage &e) {
    throw Error(e.what());
  }
}

} // namespace curve_proximity
