/* SPDX-License-Identifier: BSD-3-Clause */
/* Alternating projections between two convex cores (W. Cheney, A. Goldstein, Proc. AMS 10, 1959), made fast by
 * Newton's method, for cores whose nearest points are known in closed form.
 *
 *   1. Project a point of b onto a, and the result onto b: v joins the two points, and |v| is an upper bound.
 *   2. The direction u of v gives the lower bound phi(u) by both support functions.
 *   3. End when the bounds have met. If they touch, GJK and EPA take over.
 *   4. Take the smooth pieces of the surfaces at both points by their tangents and curvatures, solve for the
 *      nearest points of the two pieces (2 to 4 unknowns), and go on from there with 1.
 *
 * Departure: plain projections converge linearly. Step 4 is a Newton step, and where it does not shorten v the next
 * round goes on from the last projection. alternating_smooth() does without projections: Newton's method on phi(u)
 * alone.
 *
 * Letters as in doc/convex-pairs.md: v = a - b between two points of the cores, the columns m of the pieces'
 * tangents (of b's with the sign turned), x how far to go along each. All in a's frame but where it says otherwise. */
#include "convex/alternating_projections.h"

#include "base/rotation.h"
#include "convex/feature.h"

enum { ALTERNATING_ROUNDS = 10, ALTERNATING_MOST = 4 };

/* Tangents less than this apart, in radians, are parallel: their product would be no direction to trust. */
static const double ALTERNATING_PARALLEL = 1e-3;

/* Of a pivot: what is left of a unit vector that depends on the others. */
static const double ALTERNATING_DEPENDENT = 1e-12;

/* Of a step of the direction, in radians or nearly so. */
static const double SMOOTH_FARTHEST = 0.5;

typedef struct alternating_pair {
  convex_foot a, b; /* b's in its own frame */
  vec3 v;
  double distance;
  int n; /* tangents of both pieces together, and those that are a's */
  int of_a;
  vec3 m[ALTERNATING_MOST];
  double bent[ALTERNATING_MOST]; /* curvature of the piece times the distance: 1/along - 1 */
} alternating_pair;

static void alternating_add_tangents(const convex_foot *foot, const double *r, alternating_pair *p) {
  for (int i = 0; i < foot->tangents && i < 2; i++) {
    p->m[p->n] = r ? vec_neg(rotate(r, foot->e[i])) : foot->e[i];
    p->bent[p->n++] = 1.0 / foot->along[i] - 1.0;
  }
}

/* y onto a, and what it becomes there onto b. */
static void alternating_project(const alternating_task *task, vec3 y, alternating_pair *p) {
  const double *r = task->r;
  const vec3 t = task->t;
  task->a->ops->project(task->a, y, &p->a);
  task->b->ops->project(task->b, rotate_back(r, vec_sub(p->a.point, t)), &p->b);
  p->v = vec_sub(p->a.point, vec_add(rotate(r, p->b.point), t));
  p->distance = vec_norm(p->v);
  p->n = 0;
  alternating_add_tangents(&p->a, NULL, p);
  p->of_a = p->n;
  alternating_add_tangents(&p->b, r, p);
}

/* Where the two pieces, continued and v apart, are nearest to each other: min over x of |v + sum x_k m_k|²/2 + sum
 * bent_k x_k²/2, by Cholesky's method; of tangents that depend on those before them none is gone along. */
static void alternating_newton(const alternating_pair *p, vec3 v, double x[ALTERNATING_MOST]) {
  double l[ALTERNATING_MOST][ALTERNATING_MOST], z[ALTERNATING_MOST];
  for (int i = 0; i < p->n; i++) {
    z[i] = -vec_dot(p->m[i], v);
    double pivot = 1.0 + p->bent[i];
    for (int k = 0; k < i; k++) {
      double g = vec_dot(p->m[i], p->m[k]);
      for (int j = 0; j < k; j++) g -= l[i][j] * l[k][j];
      l[i][k] = l[k][k] > 0.0 ? g / l[k][k] : 0.0;
      pivot -= l[i][k] * l[i][k];
      z[i] -= l[i][k] * z[k];
    }
    l[i][i] = pivot > ALTERNATING_DEPENDENT ? sqrt(pivot) : 0.0;
    z[i] = l[i][i] > 0.0 ? z[i] / l[i][i] : 0.0;
  }
  for (int i = p->n - 1; i >= 0; i--) {
    x[i] = z[i];
    for (int k = i + 1; k < p->n; k++) x[i] -= l[k][i] * x[k];
    x[i] = l[i][i] > 0.0 ? x[i] / l[i][i] : 0.0;
  }
}

/* The direction from b to a across both pieces. Near contact v itself is all rounding, and along an edge or a face a
 * direction that is off by a little costs its length: so what is along a tangent is taken out of it. */
static vec3 alternating_direction(const alternating_pair *p) {
  vec3 along, u;
  feature_unit(p->v, &along);
  if (p->n == 0) return along;
  int other = 1;
  vec3 normal = vec(0, 0, 0);
  while (other < p->n && vec_norm2(normal) < ALTERNATING_PARALLEL * ALTERNATING_PARALLEL)
    normal = vec_cross(p->m[0], p->m[other++]);
  if (vec_norm2(normal) < ALTERNATING_PARALLEL * ALTERNATING_PARALLEL) {
    const vec3 once = vec_axpy(p->v, -vec_dot(p->v, p->m[0]), p->m[0]);
    feature_unit(once, &u);
    feature_unit(vec_axpy(u, -vec_dot(u, p->m[0]), p->m[0]), &u);
    return u;
  }
  feature_unit(normal, &u);
  return vec_dot(u, along) < 0.0 ? vec_neg(u) : u;
}

/* The part of t that no step along the pieces takes up. */
static vec3 alternating_rest(const alternating_pair *p, vec3 t) {
  double x[ALTERNATING_MOST];
  alternating_newton(p, t, x);
  for (int k = 0; k < p->n; k++) t = vec_axpy(t, x[k], p->m[k]);
  return t;
}

/* The distance is that of the pieces: it has no second derivative along what they take up, and 1/distance across. */
static void alternating_describe_curved(const alternating_pair *p, vec3 u, pair_feature *feature) {
  vec3 e, f;
  feature_tangents(u, &e, &f);
  const vec3 re = alternating_rest(p, e), rf = alternating_rest(p, f);
  const double ee = vec_dot(e, re) / p->distance, ef = vec_dot(e, rf) / p->distance, ff = vec_dot(f, rf) / p->distance;
  const double x[3] = {e.x, e.y, e.z}, y[3] = {f.x, f.y, f.z};
  for (int i = 0, k = 0; i < 3; i++)
    for (int j = i; j < 3; j++)
      feature->hessian[k++] = ee * x[i] * x[j] + ef * (x[i] * y[j] + y[i] * x[j]) + ff * y[i] * y[j];
}

/* Points of the pieces continued, as far along tangents that are not parallel as the shapes are large, take the place
 * of vertices. */
static void alternating_describe_flat(const alternating_task *task, const alternating_pair *p, pair_feature *feature) {
  feature->n = 1;
  feature->w[0] = p->v, feature->b[0] = p->b.point;
  for (int k = 0; k < p->n && feature->n < 3; k++) {
    const bool of_b = k >= p->of_a;
    const double far = of_b ? task->b->scale : task->a->scale;
    const vec3 w = vec_axpy(p->v, far, p->m[k]);
    if (feature->n == 2) {
      vec3 first;
      feature_unit(vec_sub(feature->w[1], p->v), &first);
      if (vec_norm2(vec_cross(first, p->m[k])) < ALTERNATING_PARALLEL * ALTERNATING_PARALLEL) continue;
    }
    feature->w[feature->n] = w;
    feature->b[feature->n++] = of_b ? vec_axpy(p->b.point, far, p->b.e[k - p->of_a]) : p->b.point;
  }
}

static void alternating_describe(const alternating_task *task, const alternating_pair *p, alternating_answer *answer) {
  answer->described = true;
  task->feature->flat = !task->a->ops->curvature && !task->b->ops->curvature;
  if (task->feature->flat)
    alternating_describe_flat(task, p, task->feature);
  else
    alternating_describe_curved(p, answer->u, task->feature);
}

/* The points of the cores that are nearest to each other along u, phi(u), and u if it is the best. */
static simplex_vertex alternating_support_step(const alternating_task *task, vec3 u, alternating_answer *answer) {
  simplex_vertex x = {.id = -1};
  task->a->ops->support(task->a, vec_neg(u), NULL, &x.a);
  task->b->ops->support(task->b, rotate_back(task->r, u), NULL, &x.b);
  x.w = vec_sub(x.a, vec_add(rotate(task->r, x.b), task->t));
  const double phi = vec_dot(u, x.w);
  answer->looks++;
  if (phi > answer->lower) {
    answer->lower = phi;
    answer->u = u;
  }
  return x;
}

static bool alternating_is_reached(const alternating_task *task, alternating_answer *answer) {
  answer->reached = pair_is_reached(task->goal, task->margins, task->rounding, answer->lower, answer->distance);
  return answer->reached;
}

void alternating_search(const alternating_task *task, alternating_answer *answer) {
  *answer = (alternating_answer){.pair = {.id = -1}, .distance = INFINITY, .lower = -INFINITY};
  vec3 y = task->goal->placed ? task->goal->place : task->t;
  bool newton = false;
  vec3 back = y; /* the last place on b, for when Newton's step was too long */
  for (int round = 0; round < ALTERNATING_ROUNDS && answer->looks + 1 < task->goal->max_steps; round++) {
    alternating_pair p;
    alternating_project(task, y, &p);
    answer->met = p.distance <= task->contact_tolerance;
    if (answer->met) {
      answer->pair.a = p.a.point;
      answer->pair.b = p.b.point;
      return;
    }
    if (!(p.distance < answer->distance)) {
      if (!newton) return;
      newton = false;
      y = back;
      continue;
    }
    answer->distance = p.distance;
    answer->pair.w = p.v;
    answer->pair.a = p.a.point;
    answer->pair.b = p.b.point;

    const vec3 u = alternating_direction(&p);
    if (vec_norm2(u) > 0.0) alternating_support_step(task, u, answer);
    if (alternating_is_reached(task, answer)) {
      if (task->feature) alternating_describe(task, &p, answer);
      return;
    }

    double x[ALTERNATING_MOST];
    alternating_newton(&p, p.v, x);
    y = back = vec_sub(p.a.point, p.v);
    newton = true;
    for (int i = p.of_a; i < p.n; i++) y = vec_axpy(y, -x[i], p.m[i]);
  }
}

/* ---- smooth cores ---- */

/* Newton's step for phi at u, whose point is x: (K + d) delta = x_tangential. False where the surfaces are flatter than
 * doubles tell. */
static bool smooth_step(const alternating_task *task, const simplex_vertex *x, vec3 u, double d, double delta[2],
                        vec3 *e, vec3 *f) {
  const double *r = task->r;
  double ha[6], hb[6];
  feature_tangents(u, e, f);
  const vec3 eb = rotate_back(r, *e), fb = rotate_back(r, *f);
  task->a->ops->curvature(task->a, vec_neg(u), x->a, ha);
  task->b->ops->curvature(task->b, rotate_back(r, u), x->b, hb);
  const double ee = feature_quadratic(ha, *e, *e) + feature_quadratic(hb, eb, eb) + d;
  const double ef = feature_quadratic(ha, *e, *f) + feature_quadratic(hb, eb, fb);
  const double ff = feature_quadratic(ha, *f, *f) + feature_quadratic(hb, fb, fb) + d, det = ee * ff - ef * ef;
  const double ge = vec_dot(x->w, *e), gf = vec_dot(x->w, *f);
  delta[0] = (ff * ge - ef * gf) / det;
  delta[1] = (ee * gf - ef * ge) / det;
  return det > 0.0;
}

void alternating_smooth(const alternating_task *task, vec3 u, alternating_answer *answer) {
  *answer = (alternating_answer){.pair = {.id = -1}, .distance = INFINITY, .lower = -INFINITY};
  for (int round = 0; round < ALTERNATING_ROUNDS && answer->looks + 1 < task->goal->max_steps; round++) {
    const simplex_vertex x = alternating_support_step(task, u, answer);
    const double distance = vec_norm(x.w), phi = vec_dot(u, x.w);
    if (distance < answer->distance) {
      answer->distance = distance;
      answer->pair = x;
    }
    if (distance <= task->contact_tolerance) return;
    if (alternating_is_reached(task, answer)) return;
    double delta[2];
    vec3 e, f;
    if (!smooth_step(task, &x, u, 0.5 * (greater(phi, 0.0) + distance), delta, &e, &f)) return;
    const double length = feature_hypot(delta[0], delta[1]);
    const double scale = length > SMOOTH_FARTHEST ? SMOOTH_FARTHEST / length : 1.0;
    feature_unit(vec_axpy(vec_axpy(u, scale * delta[0], e), scale * delta[1], f), &u);
  }
}
