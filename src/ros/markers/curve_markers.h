/* SPDX-License-Identifier: BSD-3-Clause */
/** Curves and closest pairs as markers. */
#ifndef CURVE_PROXIMITY_ROS_CURVE_MARKERS_H
#define CURVE_PROXIMITY_ROS_CURVE_MARKERS_H

#include <vector>

#include "markers/canvas.h"
#include "queries/queries.h"

namespace curve_proximity {

/** A body where it stands, for the colours of what comes near it. */
struct StandingBody {
  const cprox_body *body;
  Eigen::Isometry3d pose; /**< in the fixed frame */
  double padding;         /**< [m] */
};
using StandingBodies = std::vector<StandingBody>;

/** [m] The least plain distance of a ball to the bodies; infinite where there are none. */
double clearance(const cprox_vec3 &centre, double radius, const StandingBodies &placed);

/** A tube along the points, a colour a point; of radius 0 a thin one. RViz turns its line to the viewer. */
void addTube(Canvas &canvas, const std::string &space, const std::vector<Eigen::Vector3d> &points,
             const std::vector<std_msgs::ColorRGBA> &tints, double radius);

/** A curve of the scene, at its object's pose. */
void addObstacleCurve(Canvas &canvas, const Geometry &geometry, const Eigen::Isometry3d &pose, double padding);

void addCurve(Canvas &canvas, const CompiledCurve &curve, const StandingBodies &placed, std::size_t samples);

/** The nearest of those that have measured a pair; null where none has. */
const Answer *nearestOf(const std::vector<Answer> &answers);

/** The two points of an answer that has a pair, with a line between them, and the distance in words. */
void addPair(Canvas &canvas, const Answer &answer);

} // namespace curve_proximity
#endif
