/* SPDX-License-Identifier: BSD-3-Clause */
/** Curves, both ways. */
#ifndef CURVE_PROXIMITY_ROS_CURVE_MESSAGE_H
#define CURVE_PROXIMITY_ROS_CURVE_MESSAGE_H

#include <curve_proximity/Curve.h>

#include <curve_proximity/query.hpp>
#include <Eigen/Geometry>

namespace curve_proximity {

/** A curve with its points brought to the fixed frame. An empty parameter range becomes the whole of the curve.
 *  What is wrong with the curve itself is left to compile(). */
CurveDescription toDescription(const Curve &curve, const Eigen::Isometry3d &frame_in_fixed);
/** The same in the memory of another description. */
void toDescription(const Curve &curve, const Eigen::Isometry3d &frame_in_fixed, CurveDescription &out);

/** The way back, for what was a message. Throws Error for a curve with a pose of its own. */
Curve toMessage(const CurveDescription &curve);

} // namespace curve_proximity
#endif
