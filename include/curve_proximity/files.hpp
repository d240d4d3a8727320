/* SPDX-License-Identifier: BSD-3-Clause */
/** Scene and trajectory files, as the command line reads them: doc/formats.md. */
#ifndef CURVE_PROXIMITY_FILES_HPP
#define CURVE_PROXIMITY_FILES_HPP

#include <string>
#include <vector>

#include <curve_proximity/robot.hpp>
#include <curve_proximity/scene.hpp>
#include <curve_proximity/srdf.hpp>
#include <curve_proximity/trajectory.hpp>

namespace curve_proximity {

/** A further robot of a scene file, along a trajectory. */
struct MovingRobotFile {
  std::string name;                                       /**< names it in answers */
  std::string urdf;                                       /**< file, absolute */
  std::string srdf;                                       /**< file, absolute; or empty */
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity(); /**< its root link, or its virtual joint's parent frame */
  TrajectoryDescription trajectory;                       /**< its fixed_joints are joints at rest */
  double start = 0.0;                                     /**< [s] is added to all times */
  double tolerance = 0.0;                                 /**< of the start, as MovingRobot has it */
};

/** What a scene file says. */
struct SceneFileContents {
  /** For Scene::apply(). All poses are in the fixed frame, all paths of mesh files absolute. It clears the scene unless
   *  the file is a diff. */
  SceneChange change;
  JointPositions joints; /**< robot_state, as far as the robot has these joints */
  /** Where robot_state puts the root link, by the SRDF's virtual joint: what placeOf() takes. */
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
  std::vector<MovingRobotFile> moving_robots; /**< further robots, for Movers */
  std::vector<std::string> warnings;          /**< what was ignored, a message each */
};

/** Reads a scene file (YAML) for a robot, or for none: without a robot what is attached to links stands where it is,
 * and frames of links are not known. srdf: the parent frame of its virtual joint is the fixed frame, as the robot's
 * root link is. Throws Error, which names the file and the place: anything that would leave an object out or put it
 *  elsewhere. */
SceneFileContents loadSceneFile(const std::string &path, const Robot *robot = nullptr, const Srdf &srdf = {});

/** Reads a trajectory file (YAML); its id is the file's stem. warnings: what was ignored is added, a message each.
 *  Throws Error, which names the file and the place. */
TrajectoryDescription loadTrajectoryFile(const std::string &path, std::vector<std::string> *warnings = nullptr);

} // namespace curve_proximity
#endif
