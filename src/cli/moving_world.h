/* SPDX-License-Identifier: BSD-3-Clause */
/** What moves in the scene, with the robot of the command line or without. */
#ifndef CURVE_PROXIMITY_CLI_MOVING_WORLD_H
#define CURVE_PROXIMITY_CLI_MOVING_WORLD_H

#include <array>
#include <curve_proximity/movers.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "answers.h"
#include "console.h"
#include "world_files.h"

namespace curve_proximity::cli {

/** All that moves in a scene, on one clock. */
struct MovingWorld {
  std::optional<MovingRobot> subject; /**< the robot of the command line */
  std::vector<MovingRobot> others;    /**< those of the scene */
  Movers movers;                      /**< all of them */
  std::string rider = "";             /**< the body of --path, one of these; empty: none */
  std::array<double, 2> rides{};      /**< [s] from when to when it is on its way */
};

/** The robots that a scene has beside that of the command line. origin: [ns] the stamp of time 0; 0: none. Throws
 *  BadUsage with one line. */
std::vector<MovingRobot> furtherRobots(const Arguments &arguments, const World &world, std::int64_t origin = 0);

/** subject: along --trajectory; null: nobody. Throws BadUsage with one line. */
MovingWorld gatherMovers(const Arguments &arguments, const World &world, std::shared_ptr<const RobotMotion> subject);

/** The robot along --trajectory, or the body of --path, against all that stands and moves; without either all that
 *  moves. Kept by reference. */
Asked askedAmong(const MovingWorld &moving, const Arguments &arguments);

/** The robot along --trajectory, against all that stands and moves in the scene. Throws BadUsage with one line. */
int answerAmongMovers(const Arguments &arguments, const World &world, Warnings &warnings, Console &console);

} // namespace curve_proximity::cli
#endif
