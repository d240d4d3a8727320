/* SPDX-License-Identifier: BSD-3-Clause */
/** The robot of a command line along its trajectory. */
#ifndef CURVE_PROXIMITY_CLI_TRAJECTORY_H
#define CURVE_PROXIMITY_CLI_TRAJECTORY_H

#include <curve_proximity/motion.hpp>

#include "answers.h"
#include "world_files.h"

namespace curve_proximity::cli {

/** Reads --trajectory. Throws BadUsage with one line. */
RobotMotion readMotion(const Arguments &arguments, const World &world, Warnings &warnings);

/** Warns of joints beyond their limits, and of links of the SRDF that the robot does not have. */
void warnOfMotion(const RobotMotion &motion, const Arguments &arguments, const World &world, Warnings &warnings);

/** What --timings and --skipped ask for: how long reading took, and what of world and motion takes no part. */
void tellOfReading(const World &world, const RobotMotion &motion, const Arguments &arguments, Console &console);

/** Reads --trajectory, for the world's robot. Throws BadUsage with one line. */
TrajectoryDescription readOwnTrajectory(const Arguments &arguments, const World &world, Warnings &warnings);

/** What a trajectory does not move. */
struct Rest {
  JointPositions joints;   /**< --state, then its own fixed_joints, then the scene's robot_state */
  Eigen::Isometry3d place; /**< of the robot's root link, or of the frame that its base moves in */
};
Rest restOf(const TrajectoryDescription &trajectory, const World &world);

/** The file's name without folder and extension. */
std::string stemOf(const std::string &path);

/** The robot along --trajectory, against the objects or `self`; kept by reference. */
Asked askedAlong(const RobotMotion &motion, bool self, const Arguments &arguments);

} // namespace curve_proximity::cli
#endif
