/* SPDX-License-Identifier: BSD-3-Clause */
/** The robot as markers: standing, and along a trajectory. */
#ifndef CURVE_PROXIMITY_ROS_MOTION_MARKERS_H
#define CURVE_PROXIMITY_ROS_MOTION_MARKERS_H

#include "markers/canvas.h"
#include "markers/curve_markers.h"
#include "queries/queries.h"

namespace curve_proximity {

/** The links where they stand; they join the bodies that colours are measured against. */
void addRobot(Canvas &canvas, const Snapshot &scene, const LinkPoses &links, const ResourceOptions &resources,
              StandingBodies &placed);

/** The robot of a drawing at its closest moment, on its way, and the way of the point that comes closest. scene:
 * as it is now; objects: those of it. */
void addMotion(Canvas &canvas, const Snapshot &scene, const Drawing &drawing, const ResourceOptions &resources,
               const StandingBodies &objects);

} // namespace curve_proximity
#endif
