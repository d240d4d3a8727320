/* SPDX-License-Identifier: BSD-3-Clause */
/** What the 3-D view of a report draws, as JSON: bodies, where they stand at some moments, curves. */
#ifndef CURVE_PROXIMITY_CLI_REPORT_DRAWING_H
#define CURVE_PROXIMITY_CLI_REPORT_DRAWING_H

#include <curve_proximity/motion.hpp>
#include <vector>

#include "json.h"
#include "moving_world.h"
#include "world_files.h"

namespace curve_proximity::cli {

/** Adds to `out`
 *    bodies: [{name, kind: "object" | "link" | "mover", on, vertices: [x, y, z, …], triangles: [i, j, k, …]}], those of
 *            kind object in the fixed frame, the others in the frame `on`,
 *    frames: {times: [t, …], poses: {on: [[x, y, z, qx, qy, qz, qw], …]}}, a pose for each time.
 * motion: null where the robot stands, or there is none. times: ascending. */
void drawWorld(const World &world, const RobotMotion *motion, const std::vector<double> &times, Json &out);

/** Adds to the bodies and frames of drawWorld() what moves beside the robot. */
void drawMovers(const World &world, const MovingWorld &moving, const std::vector<double> &times, Json &out);

/** A curve as {name, radius, t: [t, …], points: [x, y, z, …]}. */
Json drawCurve(const CompiledCurve &curve, Workspace &workspace);

} // namespace curve_proximity::cli
#endif
