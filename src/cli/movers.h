/* SPDX-License-Identifier: BSD-3-Clause */
/** What moves in the scene, with the robot of the command line or without. */
#ifndef CURVE_PROXIMITY_CLI_MOVERS_H
#define CURVE_PROXIMITY_CLI_MOVERS_H

#include "console.h"
#include "world.h"

namespace curve_proximity::cli {

/** The robot along --trajectory, against all that stands and moves in the scene. Throws BadUsage with one line. */
int answerAmongMovers(const Arguments &arguments, const World &world, Warnings &warnings, Console &console);

} // namespace curve_proximity::cli
#endif
