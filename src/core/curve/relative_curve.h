/* SPDX-License-Identifier: BSD-3-Clause */
/* Two movers synchronized: where the first is, seen from the second, is a curve of the same parameter. */
#ifndef CPROX_CURVE_RELATIVE_CURVE_H
#define CPROX_CURVE_RELATIVE_CURVE_H

#include "base/workspace.h"
#include "curve/curve.h"

/* psi(t) - (R phi(t) + x) for t in [t0, t1], the pose being (R, x): pieces between the joints of both, of the higher
 * degree, the rounding of the conversion in their errors. It lives in the buffer of the workspace until the next one
 * is made there. False where memory is out. Both curves have the same domain. */
bool relative_create(const cprox_curve *first, const cprox_curve *second, const cprox_pose *pose, double t0, double t1,
                     cprox_workspace *workspace, workspace_buffer buffer, cprox_curve *relative);

/* The same curve over [t0, t1] with a piece between any two joints of either, of the higher degree: two that are
 * aligned with each other have the same pieces. */
bool relative_align(const cprox_curve *curve, const cprox_curve *like, double t0, double t1, cprox_workspace *workspace,
                    workspace_buffer buffer, cprox_curve *aligned);

/* Where what rides a curve is at t, the curve being placed by the pose; at a joint, where it may jump, the end of the
 * piece before if from_left is set. */
vec3 relative_position(const cprox_curve *curve, const cprox_pose *pose, double t, bool from_left,
                       cprox_workspace *workspace);

#endif
