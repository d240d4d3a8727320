/* SPDX-License-Identifier: BSD-3-Clause */
/* What is not proven of a trajectory, as messages. */
#ifndef CURVE_PROXIMITY_MOVEIT_VIOLATION_MESSAGE_H
#define CURVE_PROXIMITY_MOVEIT_VIOLATION_MESSAGE_H

#include <string>

#include <curve_proximity/ViolationIntervals.h>
#include <visualization_msgs/MarkerArray.h>

#include "certifier.h"

namespace curve_proximity {

/* The pair that comes closest, by how much and when, and the intervals that are not proven. */
ViolationIntervals toMessage(const Doubt &doubt);

/* For each doubt the witness points and a line between them, with the names of the pair. Replaces what was drawn
 * before; none: clears it. frame: the planning scene's. */
visualization_msgs::MarkerArray toMarkers(const std::vector<Doubt> &doubts, const std::string &frame);

} // namespace curve_proximity
#endif
