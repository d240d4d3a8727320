/* SPDX-License-Identifier: BSD-3-Clause */
/** What the program does, a function a command. Each returns the program's exit code and throws BadUsage with one line.
 *  */
#ifndef CURVE_PROXIMITY_CLI_COMMANDS_H
#define CURVE_PROXIMITY_CLI_COMMANDS_H

#include "arguments.h"
#include "console.h"

namespace curve_proximity::cli {

/** distance, tolerance, collision: curves against objects and robot links. */
int answerCurves(const Arguments &arguments, Console &console);

/** distance, tolerance, collision: curves against curves, row by row. */
int answerAgainst(const Arguments &arguments, Console &console);

/** The robot along a joint trajectory, against the scene and itself; speed, margins and robust are about it, too. */
int answerTrajectory(const Arguments &arguments, Console &console);

/** distance, tolerance, collision, time-of-contact: what moves in the scene, against what stands there and against each
 *  other. */
int answerMovers(const Arguments &arguments, Console &console);

/** pairs: signed distances of standing bodies. */
int answerPairs(const Arguments &arguments, Console &console);

/** constraints: values and gradients by a provider. */
int answerConstraints(const Arguments &arguments, Console &console);

/** check: what certificates prove about a query. */
int checkCertificates(const Arguments &arguments, Console &console);

/** certify: the rows of a dataset, shard by shard. */
int certifyDataset(const Arguments &arguments, Console &console);

/** merge: the shards as one table. */
int mergeShards(const Arguments &arguments, Console &console);

/** acm: which links of a robot can touch each other, and an SRDF that disables the others. */
int findLinkContacts(const Arguments &arguments, Console &console);

/** sweep: what a robot passes through along a trajectory, as cells of a grid. */
int sweepVolume(const Arguments &arguments, Console &console);

/** report: a page that shows a trajectory, or curves, and what they come close to. */
int writeReport(const Arguments &arguments, Console &console);

/** send: a scene file to a running node. */
int sendScene(const Arguments &arguments, Console &console);

} // namespace curve_proximity::cli
#endif
