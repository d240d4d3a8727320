/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/files.hpp>

#include "bad_input.h"
#include "scene_change.h"
#include "trajectory_yaml.h"

namespace curve_proximity {

SceneFileContents loadSceneFile(const std::string &path, const Robot *robot, const Srdf &srdf) {
  using namespace yaml;
  SceneFileContents out;
  Warnings warnings;
  try {
    const SceneFile file = readScene(path, warnings);
    RobotPlace place;
    try {
      if (robot) place = placeRobot(file, *robot, srdf.virtual_joints, warnings);
      const Frames frames(place.fixed, file.transforms, place.links, warnings);
      out.change = toFixedChange(file, frames, robot, place.links, warnings);
    } catch (const BadUsage &e) {
      throw Error(path + ": " + e.what());
    } catch (const Error &e) {
      throw Error(path + ": " + e.what());
    }
    out.joints = place.joints;
    out.base = place.base;
    makeResourcesAbsolute(out.change, folderOf(path));
    out.moving_robots = file.moving_robots;
    out.change.clear = !file.is_diff;
  } catch (const BadUsage &e) {
    throw Error(e.what());
  }
  out.warnings = warnings.messages();
  return out;
}

TrajectoryDescription loadTrajectoryFile(const std::string &path, std::vector<std::string> *warnings) {
  yaml::Warnings heard;
  try {
    TrajectoryDescription out = yaml::readTrajectory(path, heard);
    if (warnings) warnings->insert(warnings->end(), heard.messages().begin(), heard.messages().end());
    return out;
  } catch (const yaml::BadUsage &e) {
    throw Error(e.what());
  }
}

} // namespace curve_proximity
