/* SPDX-License-Identifier: BSD-3-Clause */
/* How the point of a curve at t changes by the numbers that define the curve: a function a kind. */
#include "base/workspace.h"
#include "curve/convert.h"
#include "curve/heading.h"

/* A quarter turn about z. */
static vec3 quarter_turn(vec3 v) {
  return vec(-v.y, v.x, 0.0);
}

/* ---- clothoids and involutes ---- */

/* psi' = T(heading + curvature t + rate t²/2): by a coefficient of the heading that stands before f(t), the derivative
 * is the integral of f times T, turned by a quarter. */
cprox_status curve_jacobian_clothoid(const cprox_curve_description *d, double t, cprox_vec3 *columns) {
  const heading_curve c = {
      .rate = d->curvature_rate, .heading = dd_from(d->heading), .curvature = dd_from(d->curvature)};
  vec3 moment[3];
  if (!heading_moments(&c, t, moment)) return CPROX_INVALID;
  columns[0] = quarter_turn(moment[0]);
  columns[1] = quarter_turn(moment[1]);
  columns[2] = vec_scale(0.5, quarter_turn(moment[2]));
  return CPROX_OK;
}

cprox_status curve_jacobian_involute(const cprox_curve_description *d, double t, cprox_vec3 *columns) {
  const angle at = angle_of(dd_sum(d->heading, t));
  const vec3 unit = vec(at.cosine + t * at.sine, at.sine - t * at.cosine, 0.0);
  columns[0] = vec_scale(d->radius, quarter_turn(unit));
  columns[1] = unit;
  return CPROX_OK;
}

/* ---- Dubins paths ---- */

/* What the end of a part depends on: the pose at its start, the turning radius, and the lengths of the three parts. */
enum { BY_X, BY_Y, BY_HEADING, BY_RADIUS, BY_LENGTH, INPUTS = BY_LENGTH + 3 };

/* A pose on the way, and its derivatives by all inputs. */
typedef struct path_pose {
  vec3 position;
  double heading;
  vec3 by[INPUTS];      /* of the position */
  double turns[INPUTS]; /* of the heading */
} path_pose;

static vec3 tangent(double heading) {
  return vec(cos(heading), sin(heading), 0.0);
}

/* Goes on by a part of this turn (-1, 0, 1), of which `grows` are the derivatives of its length. With the curvature k,
 * x' = x + the integral of T(heading + k u) over [0, length]: by k, that is (length T' - (x' - x))/k, turned by a
 * quarter less. */
static void go_on(path_pose *p, double turn, double radius, double length, const double grows[INPUTS]) {
  const double curvature = turn / radius, heading = p->heading + curvature * length;
  const vec3 before = tangent(p->heading), after = tangent(heading);
  const vec3 step = turn == 0.0 ? vec_scale(length, before)
                                : vec_scale(1.0 / curvature, vec_sub(quarter_turn(before), quarter_turn(after)));
  for (int i = 0; i < INPUTS; i++) {
    p->by[i] = vec_axpy(vec_axpy(p->by[i], p->turns[i], quarter_turn(step)), grows[i], after);
    p->turns[i] += curvature * grows[i];
  }
  if (turn != 0.0) {
    const double bends = -curvature / radius; /* the curvature's derivative by the radius */
    p->by[BY_RADIUS] = vec_axpy(p->by[BY_RADIUS], bends / curvature, vec_axpy(vec_scale(-1.0, step), length, after));
    p->turns[BY_RADIUS] += bends * length;
  }
  p->position = vec_add(p->position, step);
  p->heading = heading;
}

/* The pose at t; at the end of the path, that of its end. */
static path_pose pose_at(const cprox_curve_description *d, const cprox_dubins_path *path, double t) {
  path_pose p = {.position = d->start, .heading = d->heading};
  p.by[BY_X] = vec(1.0, 0.0, 0.0), p.by[BY_Y] = vec(0.0, 1.0, 0.0), p.turns[BY_HEADING] = 1.0;
  double from = 0.0, grows[INPUTS] = {0.0};
  for (int i = 0; i < 3; i++) {
    const double turn = curve_dubins_turn(path->word, i), to = path->ends[i];
    if (t < to) {
      /* what is left of t after the parts before: shorter by as much as they grow */
      for (int k = 0; k < i; k++) grows[BY_LENGTH + k] = -1.0;
      go_on(&p, turn, d->radius, t - from, grows);
      return p;
    }
    grows[BY_LENGTH + i] = 1.0;
    go_on(&p, turn, d->radius, to - from, grows);
    grows[BY_LENGTH + i] = 0.0;
    from = to;
  }
  return p;
}

/* x with [a0 a1 a2] x = b, by Cramer's rule; false where the determinant says nothing. */
static bool solve(const vec3 a[3], vec3 b, double x[3]) {
  const double determinant = vec_dot(a[0], vec_cross(a[1], a[2]));
  if (!(fabs(determinant) > 1e-9 * vec_norm(a[0]) * vec_norm(a[1]) * vec_norm(a[2]))) return false;
  x[0] = vec_dot(b, vec_cross(a[1], a[2])) / determinant;
  x[1] = vec_dot(b, vec_cross(a[2], a[0])) / determinant;
  x[2] = vec_dot(b, vec_cross(a[0], a[1])) / determinant;
  return true;
}

/* The lengths are those that lead to the end pose (the theorem of implicit functions). */
cprox_status curve_jacobian_dubins(const cprox_curve_description *d, double t, cprox_vec3 *columns) {
  enum { TO_X = INPUTS, TO_Y, TO_HEADING };
  static const int order[7] = {BY_HEADING, TO_HEADING, BY_RADIUS, BY_X, BY_Y, TO_X, TO_Y};
  cprox_dubins_path path;
  if (!(d->radius > 0.0) || !curve_find_dubins(d, &path)) return CPROX_INVALID;
  const path_pose at = pose_at(d, &path, t), end = pose_at(d, &path, INFINITY);
  /* poses as (x/radius, y/radius, heading) */
  const double unit = 1.0 / d->radius;
  vec3 by_length[3], out[7];
  for (int k = 0; k < 3; k++) {
    const vec3 by = end.by[BY_LENGTH + k];
    by_length[k] = vec(unit * by.x, unit * by.y, end.turns[BY_LENGTH + k]);
  }
  for (int k = 0; k < 7; k++) {
    const int by = order[k];
    vec3 missing = vec(by == TO_X ? unit : 0.0, by == TO_Y ? unit : 0.0, by == TO_HEADING ? 1.0 : 0.0);
    if (by < INPUTS) missing = vec(-unit * end.by[by].x, -unit * end.by[by].y, -end.turns[by]);
    double grows[3];
    if (!solve(by_length, missing, grows)) return CPROX_INVALID;
    out[k] = by < INPUTS ? at.by[by] : vec(0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) out[k] = vec_axpy(out[k], grows[i], at.by[BY_LENGTH + i]);
  }
  for (int k = 0; k < 7; k++) columns[k] = out[k];
  return CPROX_OK;
}

/* ---- Pythagorean hodographs ---- */

/* psi = start + sum_k h_k S_k, S_k = sum over j > k of B_j^(2m+1)(s)/(2m+1), and h_k has the term
 * C(m,i) C(m,j)/C(2m,k) B(A_i, A_j) for each i + j = k (pythagorean.c). By a component of A_i, twice the same with the
 * unit quaternion in the place of A_i. */
cprox_status curve_jacobian_pythagorean_hodograph(const cprox_curve_description *d, double t, cprox_vec3 *columns) {
  const size_t n = d->n, m = n - 1, degree = 2 * m + 1;
  if (n < 1 || degree > CPROX_MAX_DEGREE) return CPROX_INVALID;
  double sums[CPROX_MAX_DEGREE + 2];
  const cprox_curve_description as_bezier = {.kind = CPROX_CURVE_BEZIER, .n = degree + 1, .t0 = d->t0, .t1 = d->t1};
  curve_weights_bezier(&as_bezier, t, sums);
  for (size_t k = degree; k-- > 0;) sums[k] += sums[k + 1];
  for (size_t i = 0; i < n; i++) {
    cprox_vec3 *by = columns + 4 * i;
    for (int c = 0; c < 4; c++) by[c] = vec(0.0, 0.0, 0.0);
    for (size_t j = 0; j < n; j++) {
      const double share =
          (double)convert_binomial(m, i) * (double)convert_binomial(m, j) / (double)convert_binomial(2 * m, i + j);
      const double weight = 2.0 * share * sums[i + j + 1] / (double)degree;
      const cprox_quat a = d->preimage[j];
      by[0] = vec_axpy(by[0], weight, vec(a.w, a.z, -a.y));
      by[1] = vec_axpy(by[1], weight, vec(a.x, a.y, a.z));
      by[2] = vec_axpy(by[2], weight, vec(-a.y, a.x, -a.w));
      by[3] = vec_axpy(by[3], weight, vec(-a.z, a.w, a.x));
    }
  }
  return CPROX_OK;
}

/* ---- rational curves ---- */

/* psi = sum w_i B_i P_i / sum w_i B_i: by w_i, the share of point i times P_i - psi, divided by w_i. */
static cprox_status by_weights(const cprox_curve_description *d, double t, curve_weighting *weigh,
                               cprox_vec3 *columns) {
  if (d->n < 1) return CPROX_INVALID;
  /* the shares stand at the front of the columns; from the back, a column covers none that is still to be read */
  double *shares = &columns[0].x;
  weigh(d, t, shares);
  vec3 psi = vec(0.0, 0.0, 0.0);
  for (size_t i = 0; i < d->n; i++) psi = vec_axpy(psi, shares[i], d->points[i]);
  for (size_t i = d->n; i-- > 0;) {
    const double share = shares[i];
    columns[i] = vec_scale(share / d->weights[i], vec_sub(d->points[i], psi));
  }
  return CPROX_OK;
}

cprox_status curve_jacobian_rational_bezier(const cprox_curve_description *d, double t, cprox_vec3 *columns) {
  return by_weights(d, t, curve_weights_rational_bezier, columns);
}

cprox_status curve_jacobian_nurbs(const cprox_curve_description *d, double t, cprox_vec3 *columns) {
  return by_weights(d, t, curve_weights_nurbs, columns);
}
