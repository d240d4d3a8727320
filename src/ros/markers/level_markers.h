/* SPDX-License-Identifier: BSD-3-Clause */
/** Level sets of Fourier gaps as markers. */
#ifndef CURVE_PROXIMITY_ROS_LEVEL_MARKERS_H
#define CURVE_PROXIMITY_ROS_LEVEL_MARKERS_H

#include <curve_proximity/constraint_provider.hpp>
#include <memory>

#include "../../providers/constraint_case.h"
#include "markers/canvas.h"

namespace curve_proximity {

/** A pair of standing sides that a gap was asked about. */
struct LevelDrawing {
  std::shared_ptr<const Constraint> constraint; /**< its provider must outlive the drawing */
  ConstraintCase asked;
};

/** Both sides, and lines through those places of side a, turned as it is and at its height, where the value is 0 (dark:
 * from there on the constraint holds), and a twentieth and 15 % of both sides' reach. Values between the points of
 * a grid are interpolated: the lines are for the eye. The finer the grid, the faster one evaluation is; all takes some
 * 0.1 s at most. */
void addLevels(Canvas &canvas, const LevelDrawing &drawing, const ResourceOptions &resources);

} // namespace curve_proximity
#endif
