/* SPDX-License-Identifier: BSD-3-Clause */
/* The second solid of a gap carried along a curve, turning or not: value and derivative at a parameter, the verdict
 * over an interval (doc/fourier.md, "Along a curve"). */
#include <stdlib.h>

#include "base/workspace.h"
#include "fourier/gap.h"

/* Of a curve by which a solid is carried or turned; `off` names what a planar gap takes no points of. */
static cprox_status check_curve(const cprox_gap *gap, const cprox_curve *curve, const char *off, bool (*is_off)(vec3 p),
                                cprox_workspace *workspace) {
  const cprox_curve_info info = cprox_curve_get_info(curve);
  if (info.kind == CPROX_CURVE_RECTIFIABLE)
    return fourier_fail(workspace, CPROX_INVALID, "a curve known by its arc lengths alone has no derivative to go by");
  vec3 p[CPROX_MAX_DEGREE + 1];
  for (size_t i = 0; gap->info.dimension == 2 && i < info.n_pieces; i++) {
    const cprox_curve_piece_info part = cprox_curve_get_piece_info(curve, i);
    const cprox_status status =
        WORKSPACE_LEND(workspace, cprox_curve_control_points(curve, part.t0, part.t1, workspace, p));
    if (status != CPROX_OK) return status;
    for (size_t k = 0; k <= info.degree; k++)
      if (is_off(p[k])) return fourier_fail(workspace, CPROX_INVALID, "%s", off);
  }
  return CPROX_OK;
}

static bool leaves_plane(vec3 p) {
  return p.z != 0.0;
}

static bool leaves_axis(vec3 p) {
  return p.x != 0.0 || p.y != 0.0;
}

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
  cprox_status status = check_curve(gap, carried->curve, "the curve leaves the plane z = 0", leaves_plane, workspace);
  if (status != CPROX_OK || !carried->turning) return status;
  const cprox_curve_info way = cprox_curve_get_info(carried->curve), turn = cprox_curve_get_info(carried->turning);
  if (way.t0 != turn.t0 || way.t1 != turn.t1)
    return fourier_fail(workspace, CPROX_INVALID, "carried->turning is over [%g, %g], and the curve over [%g, %g]",
                        turn.t0, turn.t1, way.t0, way.t1);
  return check_curve(gap, carried->turning, "a planar solid turns about z only", leaves_axis, workspace);
}

/* By a rotation vector, after `first`. */
static cprox_quat turned_by(vec3 by, cprox_quat first) {
  const double angle = vec_norm(by), s = angle > 0.0 ? sin(0.5 * angle) / angle : 0.5, w = cos(0.5 * angle);
  const vec3 v = vec_scale(s, by), u = vec(first.x, first.y, first.z);
  const vec3 out = vec_add(vec_add(vec_scale(w, u), vec_scale(first.w, v)), vec_cross(v, u));
  return (cprox_quat){w * first.w - vec_dot(v, u), out.x, out.y, out.z};
}

/* The angular velocity in the world: the rate, turned by the mean of all rotations up to the vector. */
static vec3 angular_velocity(vec3 by, vec3 rate) {
  const double a2 = vec_norm2(by), angle = sqrt(a2);
  const double one = angle > 1e-2 ? (1.0 - cos(angle)) / a2 : 0.5 - a2 / 24.0;
  const double two = angle > 1e-2 ? (angle - sin(angle)) / (a2 * angle) : 1.0 / 6.0 - a2 / 120.0;
  const vec3 across = vec_cross(by, rate);
  return vec_add(rate, vec_add(vec_scale(one, across), vec_scale(two, vec_cross(by, across))));
}

/* Where the carried solid is, and how it moves: velocity and angular velocity, NULL if not needed. */
static cprox_status place(const cprox_gap_carried *carried, double t, cprox_workspace *workspace, cprox_pose *pose,
                          vec3 *velocity, vec3 *spin) {
  pose->orientation = carried->orientation;
  cprox_status status =
      WORKSPACE_LEND(workspace, cprox_curve_evaluate(carried->curve, t, workspace, &pose->position, velocity, NULL));
  if (status != CPROX_OK || !carried->turning) return status;
  vec3 by, rate;
  status = WORKSPACE_LEND(workspace, cprox_curve_evaluate(carried->turning, t, workspace, &by, &rate, NULL));
  pose->orientation = turned_by(by, carried->orientation);
  if (spin) *spin = angular_velocity(by, rate);
  return status;
}

cprox_status cprox_gap_along(const cprox_gap *gap, const cprox_pose *pose_a, const cprox_gap_carried *carried, double t,
                             cprox_workspace *workspace, cprox_gap_result *result, double *derivative) {
  WORKSPACE_USE(workspace);
  cprox_status status = check_arguments(gap, carried, result, workspace);
  if (status != CPROX_OK) return status;
  cprox_pose b;
  vec3 velocity, spin = vec(0, 0, 0);
  status = place(carried, t, workspace, &b, &velocity, &spin);
  if (status != CPROX_OK) return status;
  cprox_gap_result out;
  status = WORKSPACE_LEND(workspace, cprox_gap_evaluate(gap, pose_a, &b, workspace, &out));
  if (status < CPROX_OK) return status;
  *result = out;
  const frame at = frame_create(&b, vec(0, 0, 0));
  if (derivative) *derivative = vec_dot(out.position_b, velocity) + vec_dot(out.rotation_b, rotate_back(at.r, spin));
  return status;
}

typedef struct leg {
  double a, b;
} leg;

/* One polynomial piece of a curve; without a curve what it would do is 0. */
typedef struct path_piece {
  const cprox_curve *curve;
  size_t degree;
  double error;
} path_piece;

/* How far the points of a piece are from its point in the middle of a leg. */
typedef struct spread {
  vec3 middle, away[CPROX_MAX_DEGREE + 1]; /* from it to the control points, whose hull holds the piece */
  double most;                             /* the longest */
  double slack;                            /* of the piece, and of its control points' rounding */
} spread;

static cprox_status spread_leg(const path_piece *path, leg at, cprox_workspace *workspace, spread *out) {
  *out = (spread){0};
  if (!path->curve) return CPROX_OK;
  vec3 p[CPROX_MAX_DEGREE + 1];
  const double t = 0.5 * (at.a + at.b);
  cprox_status status = WORKSPACE_LEND(workspace, cprox_curve_control_points(path->curve, at.a, at.b, workspace, p));
  if (status == CPROX_OK)
    status = WORKSPACE_LEND(workspace, cprox_curve_evaluate(path->curve, t, workspace, &out->middle, NULL, NULL));
  double size = 0.0;
  for (size_t i = 0; status == CPROX_OK && i <= path->degree; i++) {
    out->away[i] = vec_sub(p[i], out->middle);
    out->most = fmax(out->most, vec_norm(out->away[i]));
    size = fmax(size, vec_norm(p[i]));
  }
  out->slack = path->error + 1e-13 * size;
  return status;
}

/* One piece of the curve and one of the turning. */
typedef struct stretch {
  const cprox_gap *gap;
  const cprox_pose *pose_a;
  cprox_quat orientation;
  path_piece way, turn;
} stretch;

/* How far from the carried origin there are points that its turning moves: of the carried solid, or seen from it of the
 * other one, which is turned then. */
static double arm_of(const cprox_gap *gap, const cprox_pose *pose_a, vec3 origin) {
  if (!gap->info.turned_first) return vec_norm(gap->centre_b) + gap->turned_reach;
  const frame a = frame_create(pose_a, vec(0, 0, 0));
  return vec_norm(vec_sub(vec_add(a.position, rotate(a.r, gap->centre_a)), origin)) + gap->turned_reach;
}

/* An upper bound of the value over the leg from value and gradient at its middle: by the tangent, which is largest at a
 * control point, and by the second order of all that moves (doc/fourier.md, "Along a curve"). */
static cprox_status bound_leg(const stretch *s, leg at, cprox_workspace *workspace, cprox_gap_result *r, double *most) {
  const cprox_gap *gap = s->gap;
  spread way, turn;
  cprox_status status = spread_leg(&s->way, at, workspace, &way);
  if (status == CPROX_OK) status = spread_leg(&s->turn, at, workspace, &turn);
  if (status != CPROX_OK) return status;
  const cprox_pose b = {way.middle, s->turn.curve ? turned_by(turn.middle, s->orientation) : s->orientation};
  const double clearance = gap_clearance(gap, s->pose_a, &b);
  const double carried = vec_norm(gap->centre_b) + gap->radius_b; /* how far from its origin it has points */
  const bool is_clear = way.most + way.slack + carried * (turn.most + turn.slack + 1e-13) < clearance;
  *r = (cprox_gap_result){.verdict = CPROX_GAP_VERDICT_FAR, .clearance = clearance};
  *most = is_clear ? 0.0 : INFINITY;
  if (is_clear || clearance > 0.0) return CPROX_OK;
  status = WORKSPACE_LEND(workspace, cprox_gap_evaluate(gap, s->pose_a, &b, workspace, r));
  if (status != CPROX_OK) return status;

  if (gap->table && s->turn.curve) {
    /* The images swing far, but add next to nothing: what is apart from them moves as the solid does. */
    const double arm = arm_of(gap, s->pose_a, way.middle);
    const double moved = way.most + way.slack + arm * (turn.most + turn.slack + 1e-13);
    *most = r->value + r->error + gap->stirring[0] * moved + gap->images;
    return CPROX_OK;
  }
  double rise = 0.0;
  for (size_t i = 0; i <= s->way.degree; i++) rise = fmax(rise, vec_dot(r->position_b, way.away[i]));
  if (!s->turn.curve) {
    *most = r->value + r->error + rise + 0.5 * gap->curvature * way.most * way.most + gap->steepness * way.slack;
    return CPROX_OK;
  }
  const double arm = arm_of(gap, s->pose_a, way.middle), moved = way.most + arm * turn.most;
  rise += vec_norm(r->rotation_b) * turn.most;
  const double bent = turn.most * (0.5 * arm * turn.most + way.most);
  const double slack = way.slack + arm * (turn.slack + 1e-13);
  *most = r->value + r->error + rise + gap->stirring[0] * (bent + slack) + 0.5 * gap->stirring[1] * moved * moved;
  return CPROX_OK;
}

enum { MOST_DEPTH = 48 };

/* Left to right. Ends with the verdict of the first leg that is not clear. */
static cprox_status search_stretch(const stretch *s, leg whole, uint32_t max_nodes, cprox_workspace *workspace,
                                   cprox_gap_along_result *out) {
  leg stack[MOST_DEPTH + 1] = {whole};
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
    const cprox_status status = bound_leg(s, at, workspace, &r, &most);
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

/* A piece of a curve, and what is left of the leg in it. */
static void cut(const cprox_curve *curve, size_t i, path_piece *path, leg *whole) {
  const cprox_curve_piece_info part = cprox_curve_get_piece_info(curve, i);
  *path = (path_piece){.curve = curve, .degree = cprox_curve_get_info(curve).degree, .error = part.error};
  *whole = (leg){fmax(whole->a, part.t0), fmin(whole->b, part.t1)};
}

cprox_status cprox_gap_along_test(const cprox_gap *gap, const cprox_pose *pose_a, const cprox_gap_carried *carried,
                                  double t0, double t1, uint32_t max_nodes, cprox_workspace *workspace,
                                  cprox_gap_along_result *result) {
  WORKSPACE_USE(workspace);
  cprox_status status = check_arguments(gap, carried, result, workspace);
  if (status != CPROX_OK) return status;
  const cprox_curve_info info = cprox_curve_get_info(carried->curve);
  if (gap->info.mode == CPROX_GAP_MODE_SIGNAL)
    return fourier_fail(workspace, CPROX_INVALID, "the signal mode has no verdict");
  if (!(t0 < t1) || !(t0 >= info.t0) || !(t1 <= info.t1))
    return fourier_fail(workspace, CPROX_INVALID, "the interval [%g, %g] must lie within [%g, %g]", t0, t1, info.t0,
                        info.t1);
  status = gap_check_pose("pose_a", pose_a, gap->info.dimension, workspace);
  const cprox_pose turned = {.orientation = carried->orientation};
  if (status == CPROX_OK) status = gap_check_pose("carried->orientation", &turned, gap->info.dimension, workspace);
  if (status != CPROX_OK) return status;
  cprox_gap_along_result out = {.verdict = CPROX_GAP_VERDICT_CLEAR, .t = t0};
  const size_t n_turns = carried->turning ? cprox_curve_get_info(carried->turning).n_pieces : 1;
  for (size_t i = 0; i < info.n_pieces; i++)
    for (size_t j = 0; j < n_turns && status == CPROX_OK && out.verdict == CPROX_GAP_VERDICT_CLEAR; j++) {
      stretch s = {.gap = gap, .pose_a = pose_a, .orientation = carried->orientation};
      leg whole = {t0, t1};
      cut(carried->curve, i, &s.way, &whole);
      if (carried->turning) cut(carried->turning, j, &s.turn, &whole);
      if (whole.a < whole.b) status = search_stretch(&s, whole, max_nodes, workspace, &out);
    }
  if (status < CPROX_OK) return status;
  *result = out;
  return status;
}
