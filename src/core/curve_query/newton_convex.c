/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/newton_convex.h"

#include "curve_query/newton_steps.h"

enum { MAX_ROUNDS = 6, MAX_STEPS = 8 };

/* A secant is drawn through points that are farther apart than this: nearer ones differ by the rounding of
 * distances. */
#define NEWTON_SECANT 1e-10

/* A measured distance this near to the predicted one, by epsilon, is that of the same feature. */
#define SAME_FEATURE 1e-3

curve_jet newton_jet(const curve_convex *o, const double *points, double s) {
  const size_t degree = o->side.curve->degree;
  curve_jet j;
  curve_bezier_evaluate(points, points + degree + 1, points + 2 * (degree + 1), 1, degree,
                        curve_binomial(o->side.curve), s, &j.x, &j.d1, &j.d2);
  return j;
}

/* From the feature that was nearest at the sample, across its tangents. */
static vec3 across(const convex_near *near, vec3 x) {
  vec3 w = vec_sub(x, near->origin);
  for (int k = 0; k < near->tangents; k++) w = vec_axpy(w, -vec_dot(near->e[k], w), near->e[k]);
  return w;
}

static vec3 symmetric_times(const double h[6], vec3 v) {
  return vec(h[0] * v.x + h[1] * v.y + h[2] * v.z, h[1] * v.x + h[3] * v.y + h[4] * v.z,
             h[2] * v.x + h[4] * v.y + h[5] * v.z);
}

/* The distance to that feature: of a plane the signed height over it, so that the deepest point is found where the
 * curve goes through; of a curved one d + n·w + w·H w/2, w = psi - y, its second order about the sample. */
static double distance_at(const curve_sample *sample, vec3 x) {
  const convex_near *near = &sample->near;
  if (near->flat && near->tangents == 2) return vec_dot(near->normal, vec_sub(x, near->origin)) - near->offset;
  if (near->flat) return vec_norm(across(near, x)) - near->offset;
  const vec3 w = vec_sub(x, sample->y);
  return near->distance + vec_dot(near->normal, w) + 0.5 * vec_dot(w, symmetric_times(near->hessian, w));
}

/* First and second derivative by s of what is least where that is: of a vertex or an edge half the square, |w|²/2,
 * whose derivatives w·psi' and |w'|² + w·psi'' take no root and divide by nothing. */
static void slopes_at(const curve_sample *sample, const curve_jet *j, double *slope, double *bend) {
  const convex_near *near = &sample->near;
  if (near->flat && near->tangents < 2) {
    const vec3 w = across(near, j->x);
    double across2 = vec_norm2(j->d1);
    for (int k = 0; k < near->tangents; k++) {
      const double along = vec_dot(near->e[k], j->d1);
      across2 -= along * along;
    }
    *slope = vec_dot(w, j->d1);
    *bend = vec_dot(w, j->d2) + greater(across2, 0.0);
    return;
  }
  vec3 gradient = near->normal;
  *bend = 0.0;
  if (!near->flat) {
    gradient = vec_add(gradient, symmetric_times(near->hessian, vec_sub(j->x, sample->y)));
    *bend = vec_dot(j->d1, symmetric_times(near->hessian, j->d1));
  }
  *slope = vec_dot(gradient, j->d1);
  *bend += vec_dot(gradient, j->d2);
}

static double clamp(double x, double least, double most) {
  return x < least ? least : x > most ? most : x;
}

/* Newton's method from the sample's s, where *j is the jet; it becomes that at the point returned. */
static double descend(const curve_convex *o, const double *points, const curve_sample *sample, double step,
                      curve_jet *j) {
  double s = sample->s;
  for (int i = 0; i < MAX_STEPS; i++) {
    double slope, bend;
    slopes_at(sample, j, &slope, &bend);
    if (!(isfinite(slope) && isfinite(bend))) break;
    const double wanted = bend > 0.0 ? -slope / bend : (slope > 0.0 ? -step : step);
    const double next = clamp(clamp(s + wanted, s - step, s + step), o->side.part.a, o->side.part.b);
    const double moved = fabs(next - s);
    if (moved < NEWTON_STANDS) break;
    s = next;
    *j = newton_jet(o, points, s);
    if (moved < NEWTON_CONVERGED) break;
  }
  return s;
}

/* ---- without derivatives ---- */

/* Parameters and distances that were measured there. */
typedef struct parabola {
  double s[3], d[3];
} parabola;

/* Where the parabola through the three is least, and how far below the least of the three; false where it has no
 * minimum. */
static bool parabola_least(const parabola *p, double *s, double *gain) {
  const double x = p->s[1] - p->s[0], y = p->s[2] - p->s[0];
  const double u = (p->d[1] - p->d[0]) / x, v = (p->d[2] - p->d[0]) / y, bend = (v - u) / (y - x);
  if (!(bend > 0.0) || !isfinite(u)) return false;
  const double slope = u - bend * x, at = -0.5 * slope / bend;
  *s = p->s[0] + at;
  *gain = 0.25 * slope * slope / bend - (p->d[0] - fmin(fmin(p->d[0], p->d[1]), p->d[2]));
  return true;
}

/* Curves that are known by points alone: the least of the parabola through three of them, again and again, and the
 * point takes the place of the one farthest from it. */
static cprox_status refine_by_points(curve_convex *o, double step) {
  enum { MOST_POINTS = 12 };
  const double least = o->side.part.a, most = o->side.part.b, from = o->best.s;
  const size_t piece = o->best.piece;
  const double low = greater(from - step, least), high = lesser(from + step, most);
  const double third = from > low && from < high ? low : 0.5 * (low + high);
  parabola p = {.s = {from, from < high ? high : low, third}, .d = {o->best.near.distance}};
  const double error = curve_side_point_error(&o->side);
  for (int i = 1; i < MOST_POINTS; i++) {
    int at = i;
    if (i >= 3) {
      double s, gain;
      if (!parabola_least(&p, &s, &gain)) return CPROX_OK;
      s = clamp(clamp(s, o->best.s - step, o->best.s + step), least, most);
      at = 0;
      for (int k = 1; k < 3; k++)
        if (fabs(p.s[k] - s) > fabs(p.s[at] - s)) at = k;
      const bool new = s != p.s[0] && s != p.s[1] && s != p.s[2];
      if (!new || !(gain > 0.1 * o->effort.epsilon)) return CPROX_OK;
      p.s[at] = s;
    }
    curve_sample sample;
    search_best bound = {.upper = INFINITY};
    const vec3 x = curve_side_point(&o->side, p.s[at]);
    const cprox_status status = curve_convex_measure(o, piece, p.s[at], x, error, &sample, &bound);
    if (status < 0) return status;
    p.d[at] = sample.near.distance;
    if (bound.upper < o->best_bound.upper) curve_convex_adopt(o, &sample, bound);
    if (o->best_bound.upper <= o->effort.good_enough) return CPROX_OK;
  }
  return CPROX_OK;
}

/* ---- a radius that changes ---- */

/* The slope of the distance less the radius at a sample, and its bend, which of the distance is that from the nearest
 * point: the largest there can be. */
static void thick_slopes(curve_convex *o, const curve_sample *sample, double *slope, double *bend) {
  const curve_thickness radius = curve_side_thickness(&o->side, sample->piece, sample->s);
  const curve_jet j = newton_jet(o, points_pool_at(&o->pool, CURVE_CONVEX_ROOT), sample->s);
  const double along = vec_dot(sample->normal, j.d1), d = fabs(sample->near.distance);
  *slope = along - radius.slope;
  *bend = vec_dot(sample->normal, j.d2) - radius.bend;
  if (d > 0.0) *bend += greater(vec_norm2(j.d1) - along * along, 0.0) / d;
}

/* From the best sample, by secants of the slope, until nothing gets better. The first step goes by the bend. */
static cprox_status refine_by_secants(curve_convex *o, double longest) {
  enum { MOST_SECANTS = 10 };
  const double least = o->side.part.a, most = o->side.part.b;
  curve_sample sample = o->best;
  double slope, bend;
  thick_slopes(o, &sample, &slope, &bend);
  for (int i = 0; i < MOST_SECANTS; i++) {
    const double wanted = bend > 0.0 ? -slope / bend : (slope > 0.0 ? -longest : longest), s = sample.s;
    const double next = clamp(s + clamp(wanted, -longest, longest), least, most);
    if (!(fabs(next - s) > NEWTON_SECANT)) break; /* also where a slope is not a number */
    const uint32_t before = o->incumbent;
    search_best bound = {.upper = INFINITY};
    const cprox_status status = curve_convex_measure(o, sample.piece, next, curve_side_point(&o->side, next),
                                                     curve_side_point_error(&o->side), &sample, &bound);
    if (status < 0) return status;
    if (bound.upper < o->best_bound.upper) curve_convex_adopt(o, &sample, bound);
    if (o->best_bound.upper <= o->effort.good_enough || o->incumbent == before) break;
    double there, unused;
    thick_slopes(o, &sample, &there, &unused);
    bend = (there - slope) / (next - s);
    slope = there;
  }
  return CPROX_OK;
}

/* ---- with them ---- */

cprox_status newton_refine(curve_convex *o, const double *points, curve_jet *j, double step) {
  if (o->side.curve->arcs) return refine_by_points(o, step);
  if (o->side.radius) return refine_by_secants(o, step);
  const double error = curve_side_point_error(&o->side);
  curve_sample samples[2];
  const curve_sample *from = &o->best;
  for (int round = 0; round < MAX_ROUNDS; round++) {
    const double s = descend(o, points, from, step, j);
    if (s == from->s) return CPROX_OK;
    const double predicted = distance_at(from, j->x);

    /* only a measured distance counts */
    curve_sample *sample = &samples[round % 2];
    search_best bound = {.upper = INFINITY};
    const cprox_status status = curve_convex_measure(o, from->piece, s, j->x, error, sample, &bound);
    if (status < 0) return status;
    const bool better = bound.upper < o->best_bound.upper;
    if (better) curve_convex_adopt(o, sample, bound);
    if (o->best_bound.upper <= o->effort.good_enough) return CPROX_OK;

    /* the feature held on to is the nearest one here too: nothing more to find */
    const bool same_feature = fabs(sample->near.distance - predicted) <= bound.slack + SAME_FEATURE * o->effort.epsilon;
    if (same_feature || (!better && round > 0)) return CPROX_OK;
    step *= 0.5;
    from = sample;
  }
  return CPROX_OK;
}
