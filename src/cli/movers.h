/* SPDX-License-Identifier: BSD-3-Clause */
/** What moves in the scene, with the robot of the command line or without. */
#ifndef CURVE_PROXIMITY_CLI_MOVERS_H
#define CURVE_PROXIMITY_CLI_MOVERS_H

#include <curve_proximity/movers.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "asking.h"
#include "console.h"
#include "world.h"

namespace curve_proximity::cli {

/** All that moves in a scene, on one clock. */
struct MovingWorld {
  std::optional<MovingRobot> subject; /**< the robot of the command line */
  std::vector<MovingRobot> others;    /**< those of the scene */
  Movers movers;                      /**< all of them */
};

/** subject: along --trajectory; null: nobody. Throws BadUsage with one line. */
MovingWorld gatherMovers(const Arguments &arguments, const World &world, std::shared_ptr<const RobotMotion> subject);

/** The subject against all that stands and moves; without a subject all that moves. Kept by reference. */
std::unique_ptr<Subject> subjectAmong(const MovingWorld &moving, const Arguments &arguments);

/** The robot along --trajectory, against all that stands and moves in the scene. Throws BadUsage with one line. */
int answerAmongMovers(const Arguments &arguments, const World &world, Warnings &warnings, Console &console);

} // namespace curve_proximity::cli
#endif
