/* SPDX-License-Identifier: BSD-3-Clause */
/** Joints that turn without end, and which way round they go from point to point. */
#ifndef CURVE_PROXIMITY_SCENE_SHORT_WAY_H
#define CURVE_PROXIMITY_SCENE_SHORT_WAY_H

#include <curve_proximity/robot.hpp>
#include <curve_proximity/trajectory.hpp>

namespace curve_proximity {

/** Adds whole turns to the values of these joints, so that none turns by more than half a turn between two waypoints.
 *  Throws Error: a spline; a joint whose followers would not be where they are after a whole turn. */
void takeShortWays(const Robot &robot, TrajectoryDescription &trajectory);

} // namespace curve_proximity
#endif
