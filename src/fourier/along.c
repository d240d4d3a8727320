/* SPDX-License-Identifier: BSD-3-Clause */
/* The second solid of a gap carried along a curve without turning: value and derivative at a parameter, the verdict
 * over an interval (doc/fourier.md, "Along a curve"). */
#include <stdlib.h>

#include "fourier/gap.h"

static cprox_status check_arguments(const cprox_gap *gap, const cprox_gap_carried *carried, const void *result,
                                    cprox_workspace *workspace) {
  fourier_clear(workspace);
  if (!workspace) return CPROX_INVALID;
  const char *missing = !gap              ? "gap"
                        : !carried        ? "carried"
                        : !carried->curve ? "carried->curve"
                        : !result         ? "result"
                                          : NULL;
  if (missing) return fourier_fail(workspace, CPROX_INVALID, "%s is NULL", missing);
  const cprox_curve_info info = cprox_curve_get_info(carried->curve);
  if (info.kind == CPROX_CURVE_RECTIFIABLE)
    return fourier_fail(workspace, CPROX_INVALID, "a curve known by its arc lengths alone has no derivative to go by");
  vec3 p[CPROX_MAX_DEGREE + 1];
  for (size_t i = 0; gap->info.dimension == 2 && i < info.n_pieces; i++) {
    const cprox_curve_piece_info part = cprox_curve_get_piece_info(carried->curve, i);
    const cprox_status status = cprox_curve_control_points(carried->curve, part.t0, part.t1, workspace, p);
    if (status != CPROX_OK) return status;
    for (size_t k = 0; k <= info.degree; k++)
      if (p[k].z != 0.0) return fourier_fail(workspace, CPROX_INVALID, "the curve leaves the plane z = 0");
  }
  return CPROX_OK;
}

cprox_status cprox_gap_along(const cprox_gap *gap, const cprox_pose *pose_a, const cprox_gap_carried *carried, double t,
                             cprox_workspace *workspace, cprox_gap_result *result, double *derivative) {
  cprox_status status = check_arguments(gap, carried, result, workspace);
  if (status != CPROX_OK) return status;
  cprox_pose b = {.orientation = carried->orientation};
  vec3 velocity;
  status = cprox_curve_evaluate(carried->curve, t, workspace, &b.position, &velocity, NULL);
  if (status != CPROX_OK) return status;
  cprox_gap_result out;
  status = cprox_gap_evaluate(gap, pose_a, &b, workspace, &out);
  if (status < CPROX_OK) return status;
  *result = out;
  if (derivative) *derivative = vec_dot(out.position_b, velocity);
  return status;
}

/* An upper bound of the value over [a, b] from value and gradient at its middle: the curve lies in the hull of its
 * control points, and along the line to any of its points the value is below its tangent plus half the curvature's
 * square. */
typedef struct leg {
  double a, b;
} leg;

/* One polynomial piece of the curve. */
typedef struct path_piece {
  const cprox_curve *curve;
  size_t degree;
  double error;
} path_piece;

static cprox_status bound_leg(const cprox_gap *gap, const cprox_pose *pose_a, const path_piece *path, cprox_pose *b,
                              leg at, cprox_workspace *workspace, cprox_gap_result *r, double *most) {
  vec3 p[CPROX_MAX_DEGREE + 1], middle;
  const double t = 0.5 * (at.a + at.b);
  cprox_status status = cprox_curve_control_points(path->curve, at.a, at.b, workspace, p);
  if (status == CPROX_OK) status = cprox_curve_evaluate(path->curve, t, workspace, &middle, NULL, NULL);
  if (status != CPROX_OK) return status;
  b->position = middle;
  status = cprox_gap_evaluate(gap, pose_a, b, workspace, r);
  if (status != CPROX_OK) return status;

  double away = 0.0, rise = 0.0, size = 0.0;
  for (size_t i = 0; i <= path->degree; i++) {
    const vec3 d = vec_sub(p[i], middle);
    away = fmax(away, vec_norm(d));
    rise = fmax(rise, vec_dot(r->position_b, d));
    size = fmax(size, vec_norm(p[i]));
  }
  const double slack = path->error + 1e-13 * size; /* of the curve, and of its control points' rounding */
  if (r->verdict == CPROX_GAP_VERDICT_FAR)
    *most = away + slack < r->clearance ? 0.0 : INFINITY;
  else
    *most = r->value + r->error + rise + 0.5 * gap->curvature * away * away + gap->steepness * slack;
  return CPROX_OK;
}

enum { MOST_DEPTH = 48 };

/* One polynomial piece, left to right. Ends with the verdict of the first leg that is not clear. */
static cprox_status search_piece(const cprox_gap *gap, const cprox_pose *pose_a, const path_piece *path,
                                 const cprox_quat *orientation, leg whole, uint32_t max_nodes,
                                 cprox_workspace *workspace, cprox_gap_along_result *out) {
  leg stack[MOST_DEPTH + 1] = {whole};
  cprox_pose b = {.orientation = *orientation};
  size_t n = 1;
  while (n > 0) {
    const leg at = stack[n - 1];
    cprox_gap_result r;
    double most;
    if (out->nodes >= max_nodes) {
      out->verdict = CPROX_GAP_VERDICT_UNDECIDED, out->t = at.a;
      return fourier_fail(workspace, CPROX_BUDGET, "%u nodes were not enough; clear up to t = %g", max_nodes, at.a);
    }
    out->nodes++;
    const cprox_status status = bound_leg(gap, pose_a, path, &b, at, workspace, &r, &most);
    if (status != CPROX_OK) return status;
    const double t = 0.5 * (at.a + at.b);
    if (r.value > out->value) out->value = r.value, out->t = t;
    if (most < 1.0 - 1e-12) {
      n--;
    } else if (r.verdict == CPROX_GAP_VERDICT_COLLIDE || r.verdict == CPROX_GAP_VERDICT_UNDECIDED || n > MOST_DEPTH ||
               !(at.a < t && t < at.b)) {
      out->verdict = r.verdict == CPROX_GAP_VERDICT_COLLIDE ? CPROX_GAP_VERDICT_COLLIDE : CPROX_GAP_VERDICT_UNDECIDED;
      out->value = r.value, out->t = t;
      return CPROX_OK;
    } else {
      stack[n - 1] = (leg){t, at.b};
      stack[n++] = (leg){at.a, t};
    }
  }
  return CPROX_OK;
}

cprox_status cprox_gap_along_test(const cprox_gap *gap, const cprox_pose *pose_a, const cprox_gap_carried *carried,
                                  double t0, double t1, uint32_t max_nodes, cprox_workspace *workspace,
                                  cprox_gap_along_result *result) {
  cprox_status status = check_arguments(gap, carried, result, workspace);
  if (status != CPROX_OK) return status;
  const cprox_curve_info info = cprox_curve_get_info(carried->curve);
  if (gap->info.mode == CPROX_GAP_MODE_SIGNAL)
    return fourier_fail(workspace, CPROX_INVALID, "the signal mode has no verdict");
  if (!(t0 < t1) || !(t0 >= info.t0) || !(t1 <= info.t1))
    return fourier_fail(workspace, CPROX_INVALID, "the interval [%g, %g] must lie within [%g, %g]", t0, t1, info.t0,
                        info.t1);
  cprox_gap_along_result out = {.verdict = CPROX_GAP_VERDICT_CLEAR, .t = t0};
  for (size_t i = 0; i < info.n_pieces && status == CPROX_OK && out.verdict == CPROX_GAP_VERDICT_CLEAR; i++) {
    const cprox_curve_piece_info part = cprox_curve_get_piece_info(carried->curve, i);
    const path_piece path = {.curve = carried->curve, .degree = info.degree, .error = part.error};
    const leg whole = {fmax(t0, part.t0), fmin(t1, part.t1)};
    if (whole.a < whole.b)
      status = search_piece(gap, pose_a, &path, &carried->orientation, whole, max_nodes, workspace, &out);
  }
  if (status < CPROX_OK) return status;
  *result = out;
  return status;
}
