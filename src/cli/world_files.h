/* SPDX-License-Identifier: BSD-3-Clause */
/** From files to what curves are measured against. */
#ifndef CURVE_PROXIMITY_CLI_WORLD_FILES_H
#define CURVE_PROXIMITY_CLI_WORLD_FILES_H

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <curve_proximity/files.hpp>
#include <curve_proximity/scene.hpp>
#include <curve_proximity/srdf.hpp>

#include "../scene/yaml/yaml_value.h"
#include "arguments.h"
#include "exit_code.h"

namespace curve_proximity::cli {

/** A body along --path. */
struct Ride {
  ObjectDescription body;       /**< its pose is the identity; without shapes it names an object that a link carries */
  std::vector<TimedPose> poses; /**< of the body, in the fixed frame */
  std::int64_t origin = 0;      /**< [ns] the stamp of time 0; 0: none */
};

/** The scene, and where the robot's links are. */
struct World {
  SnapshotPtr snapshot;
  LinkPoses links;                            /**< empty without a robot */
  JointPositions scene_joints;                /**< the scene's robot_state, as far as the robot has its joints */
  Eigen::Isometry3d base;                     /**< where the scene's robot_state puts the robot's root link */
  JointPositions state;                       /**< --state */
  Srdf srdf;                                  /**< empty without --srdf */
  std::vector<std::string> skipped;           /**< what takes no part, a message each */
  std::vector<std::string> timings;           /**< how long loading took, a message each */
  std::vector<MovingRobotFile> moving_robots; /**< of the scene file */
  ResourceOptions resources;                  /**< where files of the scene's objects are */
  std::optional<Ride> ride;                   /**< of --path */

  /** Does anything move beside the robot of the command line? */
  bool moves() const {
    return !moving_robots.empty() || !snapshot->moving().empty();
  }
};

/** Where a robot comes from: its file, or a place where it has been read before. */
using RobotSource = std::function<std::shared_ptr<const Robot>(const std::string &path)>;

/** Reads --scene, --robot, --srdf and --state, --path and --body. Throws BadUsage with one line. robots: readRobot() if
 * empty. */
World readWorld(const Arguments &arguments, Warnings &warnings, const RobotSource &robots = {});

/** The same, and BadUsage where anything moves in the scene. what: the query that does not take it. */
World readStandingWorld(const Arguments &arguments, const std::string &what, Warnings &warnings,
                        const RobotSource &robots = {});

/** Who measures the pairs again; null: nobody. resources: where files of objects are. */
std::shared_ptr<const SecondOpinions> secondOpinions(const Arguments &arguments, const ResourceOptions &resources);

/** The query of the command line in a world, which Ctrl-C ends. warnings: all of its input; what they leave out is not
 *  covered. */
Query queryOf(const Arguments &arguments, const World &world, const Warnings &warnings);

} // namespace curve_proximity::cli
#endif
