/* SPDX-License-Identifier: BSD-3-Clause */
/** Objects and further robots that move, as markers. */
#ifndef CURVE_PROXIMITY_ROS_MOVER_MARKERS_H
#define CURVE_PROXIMITY_ROS_MOVER_MARKERS_H

#include "markers/canvas.h"
#include "queries/queries.h"

namespace curve_proximity {

/** What moves, the body along a path among it, at the moment of closest approach, with the ways of the objects'
 * origins. drawing: the last query about it; null, or one of another scene: the objects at their first poses. */
void addMovers(Canvas &canvas, const Snapshot &scene, const Drawing *drawing, const ResourceOptions &objects,
               const ResourceOptions &robots);

} // namespace curve_proximity
#endif
