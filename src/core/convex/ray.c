/* SPDX-License-Identifier: BSD-3-Clause */
/* The ray from 0 along t leaves M = {a - r b} at t/g. In n, with n·m <= 1 for all m of M, g is the greatest n·t
 * (doc/implicit.md):
 *   1. A triangle of M's extreme points that the ray pierces moves outwards (Minkowski portal refinement). Its plane
 *      and the support value along its normal bound g from both sides.
 *   2. Where the shapes are curved, Newton's method solves t = sum λ_i x_i(n), n·x_i(n) = 1 from there: x_i the extreme
 *      points of the smooth pieces on which the triangle's corners lie, their derivatives those of the kinds.
 *   3. The same matrix gives the second derivative of g by t.
 *
 * Lengths are in units of both scales together. */
#include "convex/ray.h"

#include "base/rotation.h"
#include "base/rounding.h"
#include "convex/feature.h"

enum { RAY_CORNERS = 3, RAY_ROWS = 3 + RAY_CORNERS, RAY_COLUMNS = 4, PORTAL_STEPS = 200, NEWTON_STEPS = 16 };

/* The widths of the portal, in parts of g, at which Newton's method is tried. */
static const double NEWTON_FROM = 0.05, NEWTON_AGAIN = 0.02;

/* Extreme points of one piece along one direction agree within this; steps that are shorter end Newton's method, whose
 * next one would be their square. */
static const double SAME = 1e-9, SMALL_STEP = 1e-9;

/* A triangle whose bounds are as close is as good as rounding allows. */
static const double CLOSED = 4e-15;

/* Where no curvature is known, or it changes too fast for Newton's method, a portal with bounds as close will do. */
static const double NARROW = 1e-10;

/* The rounding of a product of three vectors, in parts of their lengths. */
static const double ROUND_TRIPLE = 8.0 * ROUND_U;

/* What a tilted direction must lose for the best one to be alone. */
static const double LOSS = 2e-14;

/* So much farther a direction is tilted where supports come from a solver or a callback. */
static const double COARSER = 100.0;

typedef struct ray_vertex {
  vec3 a, b; /* of the cores, each in its own frame */
  vec3 w;    /* their difference with the margins, in the units of the search */
} ray_vertex;

typedef struct ray {
  const convex *a, *b;
  double margin_a, margin_b;
  const double *r;
  double unit; /* [m] */
  vec3 d;      /* the ray, unit */
  bool support_failed;
  uint32_t supports;
} ray;

/* An optimum: its corners, the multipliers with sum λ w = d, and the direction. */
typedef struct ray_optimum {
  int n;
  ray_vertex corner[RAY_CORNERS];
  double weight[RAY_CORNERS];
  vec3 u;        /* unit */
  double height; /* the support function of M along u */
} ray_optimum;

static vec3 ray_difference(const ray *p, vec3 a, vec3 b, vec3 u) {
  const vec3 cores = vec_sub(a, rotate(p->r, b));
  return vec_scale(1.0 / p->unit, vec_axpy(cores, p->margin_a + p->margin_b, u));
}

/* M's support function along the unit vector u, and a point that attains it. */
static double ray_extreme(ray *p, vec3 u, ray_vertex *x) {
  const double of_a = p->a->ops->support(p->a, u, NULL, &x->a);
  const double of_b = p->b->ops->support(p->b, vec_neg(rotate_back(p->r, u)), NULL, &x->b);
  if (isnan(of_a) || isnan(of_b)) p->support_failed = true;
  x->w = ray_difference(p, x->a, x->b, u);
  p->supports++;
  return fmax((of_a + of_b + p->margin_a + p->margin_b) / p->unit, vec_dot(u, x->w));
}

/* ---- the portal ---- */

static double triple(vec3 x, vec3 y, vec3 z) {
  return vec_dot(x, vec_cross(y, z));
}

/* Whether d is beyond the plane through 0, x and y, by more than rounding: where the ray passes through a corner or an
 * edge, a sign that rounding makes would turn the search in a circle. */
static bool is_beyond(vec3 x, vec3 y, vec3 d) {
  return triple(x, y, d) < -ROUND_TRIPLE * vec_norm(x) * vec_norm(y);
}

/* Three extreme points whose cone contains the ray; the normal (v2 - v1) x (v3 - v1) points outwards. `height`: M's
 * support function along the ray. */
static bool portal_open(ray *p, ray_vertex v[RAY_CORNERS], double *height) {
  *height = ray_extreme(p, p->d, &v[0]);
  vec3 aside = vec_axpy(v[0].w, -vec_dot(v[0].w, p->d), p->d), e, f;
  feature_tangents(p->d, &e, &f);
  if (!(vec_norm(aside) > 1e-12)) aside = e;
  feature_unit(vec_neg(aside), &aside);
  ray_extreme(p, aside, &v[1]);
  for (int i = 0; i < PORTAL_STEPS && !p->support_failed; i++) {
    vec3 across;
    feature_unit(vec_cross(v[0].w, v[1].w), &across);
    if (vec_norm2(across) == 0.0) feature_unit(vec_cross(v[0].w, f), &across);
    if (vec_dot(across, p->d) < 0.0) {
      const ray_vertex kept = v[0];
      v[0] = v[1], v[1] = kept;
      across = vec_neg(across);
    }
    ray_extreme(p, across, &v[2]);
    if (is_beyond(v[1].w, v[2].w, p->d)) {
      v[0] = v[2];
      continue;
    }
    if (!is_beyond(v[2].w, v[0].w, p->d) && triple(v[0].w, v[1].w, v[2].w) > 0.0) return true;
    v[1] = v[2]; /* also where the two are opposite each other */
  }
  return false;
}

/* d = sum weight * w; false for a sliver. */
static bool portal_weights(const ray_vertex v[RAY_CORNERS], vec3 d, double weight[RAY_CORNERS]) {
  const double all = triple(v[0].w, v[1].w, v[2].w);
  if (!(all > 0.0)) return false;
  for (int i = 0; i < RAY_CORNERS; i++)
    weight[i] = fmax(triple(d, v[(i + 1) % RAY_CORNERS].w, v[(i + 2) % RAY_CORNERS].w) / all, 0.0);
  return true;
}

/* Which of the three triangles at x the ray pierces: the one in which it is farthest from both edges at x. Signs alone
 * may contradict each other where it passes through a corner or an edge. */
static void portal_replace(ray_vertex v[RAY_CORNERS], const ray_vertex *x, vec3 d) {
  const vec3 c = vec_cross(d, x->w);
  const double side[RAY_CORNERS] = {vec_dot(v[0].w, c), vec_dot(v[1].w, c), vec_dot(v[2].w, c)};
  double most = -INFINITY;
  int out = 0;
  for (int i = 0; i < RAY_CORNERS; i++) {
    const double room = fmin(side[(i + 1) % RAY_CORNERS], -side[(i + 2) % RAY_CORNERS]);
    if (room > most) most = room, out = i;
  }
  v[out] = *x;
}

/* ---- Newton's method ---- */

static bool ray_follow(const convex *shape, vec3 d, vec3 *x) {
  if (!shape->ops->follow) return false;
  const vec3 moved = shape->ops->follow(shape, d, *x), step = vec_sub(moved, *x);
  const double far = 0.3 * shape->scale; /* the rim of a disc, seen along its axis, is extreme everywhere */
  if (!(vec_norm2(step) <= far * far)) return false;
  *x = moved;
  return true;
}

/* The weighted curvature of M's pieces in the plane across u. */
typedef struct ray_bend {
  vec3 e, f;
  double ee, ef, ff;
} ray_bend;

static void bend_add(ray_bend *k, double weight, const double h[6], vec3 e, vec3 f) {
  k->ee += weight * feature_quadratic(h, e, e);
  k->ef += weight * feature_quadratic(h, e, f);
  k->ff += weight * feature_quadratic(h, f, f);
}

/* The corners where u finds them on their pieces; those that fall together are one. */
static ray_bend ray_gather(const ray *p, ray_optimum *o) {
  ray_bend k = {.ee = 0.0};
  feature_tangents(o->u, &k.e, &k.f);
  const vec3 down = vec_neg(rotate_back(p->r, o->u));
  const ray_optimum old = *o;
  o->n = 0;
  for (int i = 0; i < old.n; i++) {
    ray_vertex y = old.corner[i];
    const double weight = old.weight[i];
    double h[6];
    if (ray_follow(p->a, o->u, &y.a)) {
      p->a->ops->curvature(p->a, o->u, y.a, h);
      bend_add(&k, weight / p->unit, h, k.e, k.f);
    }
    if (ray_follow(p->b, down, &y.b)) {
      p->b->ops->curvature(p->b, down, y.b, h);
      bend_add(&k, weight / p->unit, h, rotate_back(p->r, k.e), rotate_back(p->r, k.f));
    }
    const double margins = weight * (p->margin_a + p->margin_b) / p->unit;
    k.ee += margins, k.ff += margins;
    y.w = ray_difference(p, y.a, y.b, o->u);
    int twin = 0;
    while (twin < o->n && vec_norm2(vec_sub(o->corner[twin].w, y.w)) > SAME * SAME) twin++;
    if (twin == o->n) {
      o->corner[o->n] = y;
      o->weight[o->n++] = 0.0;
    }
    o->weight[twin] += weight;
  }
  return k;
}

/* Gauss with the largest pivots; columns from n on are right-hand sides. False where the matrix is singular. */
static bool solve_rows(double m[RAY_ROWS][RAY_ROWS + RAY_COLUMNS], int n, int columns) {
  double most = 0.0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) most = fmax(most, fabs(m[i][j]));
  for (int i = 0; i < n; i++) {
    int pivot = i;
    for (int k = i + 1; k < n; k++)
      if (fabs(m[k][i]) > fabs(m[pivot][i])) pivot = k;
    if (!(fabs(m[pivot][i]) > 1e-13 * most)) return false;
    for (int j = 0; j < n + columns; j++) {
      const double kept = m[i][j];
      m[i][j] = m[pivot][j], m[pivot][j] = kept;
    }
    for (int k = 0; k < n; k++) {
      const double by = m[k][i] / m[i][i];
      if (k == i || by == 0.0) continue;
      for (int j = i; j < n + columns; j++) m[k][j] -= by * m[i][j];
    }
  }
  for (int i = 0; i < n; i++)
    for (int j = n; j < n + columns; j++) m[i][j] /= m[i][i];
  return true;
}

/* (S X; X^T 0) with the right-hand sides (d; 1 - n·x) and (I; 0): the step of n, the multipliers, and how both change
 * with d. */
static bool ray_solve(const ray_optimum *o, const ray_bend *k, vec3 d, double m[RAY_ROWS][RAY_ROWS + RAY_COLUMNS]) {
  const int n = 3 + o->n;
  const double e[3] = {k->e.x, k->e.y, k->e.z}, f[3] = {k->f.x, k->f.y, k->f.z}, right[3] = {d.x, d.y, d.z};
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n + RAY_COLUMNS; j++) m[i][j] = 0.0;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      m[i][j] = o->height * (k->ee * e[i] * e[j] + k->ef * (e[i] * f[j] + f[i] * e[j]) + k->ff * f[i] * f[j]);
    m[i][n] = right[i];
    m[i][n + 1 + i] = 1.0;
  }
  for (int i = 0; i < o->n; i++) {
    const double w[3] = {o->corner[i].w.x, o->corner[i].w.y, o->corner[i].w.z};
    for (int j = 0; j < 3; j++) m[3 + i][j] = m[j][3 + i] = w[j];
    m[3 + i][n] = 1.0 - vec_dot(o->u, o->corner[i].w) / o->height;
  }
  return solve_rows(m, n, RAY_COLUMNS);
}

static void optimum_drop(ray_optimum *o, int i) {
  o->n--;
  for (; i < o->n; i++) o->corner[i] = o->corner[i + 1], o->weight[i] = o->weight[i + 1];
}

/* One step: the pieces that live, one that reaches farther, less those that would pull. False where there is none. */
static bool newton_step(ray *p, ray_optimum *o, double m[RAY_ROWS][RAY_ROWS + RAY_COLUMNS]) {
  ray_bend k = ray_gather(p, o);
  ray_vertex x;
  o->height = ray_extreme(p, o->u, &x);
  double reached = -INFINITY;
  for (int i = 0; i < o->n; i++) reached = fmax(reached, vec_dot(o->u, o->corner[i].w));
  if (reached < o->height - SAME) {
    if (o->n == RAY_CORNERS) return false;
    o->corner[o->n] = x;
    o->weight[o->n++] = 0.0;
    k = ray_gather(p, o);
  }
  for (;;) {
    if (!ray_solve(o, &k, p->d, m)) return false;
    int least = 0;
    for (int i = 1; i < o->n; i++)
      if (m[3 + i][3 + o->n] < m[3 + least][3 + o->n]) least = i;
    if (m[3 + least][3 + o->n] >= -SAME) return true;
    if (o->n == 1) return false;
    optimum_drop(o, least);
    k = ray_gather(p, o);
  }
}

/* How far the weighted mean of the corners is from the ray, in parts of its distance. */
static double optimum_misses(const ray_optimum *o, vec3 d) {
  vec3 left = d;
  for (int i = 0; i < o->n; i++) left = vec_axpy(left, -o->weight[i], o->corner[i].w);
  return vec_norm(left);
}

/* Solves the conditions of the optimum from a portal that is near it. hessian: by d, in the units of the search. */
static bool ray_newton(ray *p, ray_optimum *o, double hessian[6]) {
  double before = INFINITY;
  for (int step = 0; step < NEWTON_STEPS && !p->support_failed; step++) {
    double m[RAY_ROWS][RAY_ROWS + RAY_COLUMNS];
    if (!newton_step(p, o, m)) return false;
    const int right = 3 + o->n;
    const vec3 n = vec_scale(1.0 / o->height, o->u), by = vec(m[0][right], m[1][right], m[2][right]);
    const double length = vec_norm(by) / vec_norm(n);
    if (!(length < 1.0) || (step > 4 && length > SMALL_STEP && !(length < before))) return false;
    before = length;
    feature_unit(vec_add(n, by), &o->u);
    double shifted = 0.0; /* the curvatures are weighted: the hessian is no nearer than the weights */
    for (int i = 0; i < o->n; i++) {
      const double weight = fmax(m[3 + i][right], 0.0);
      shifted = fmax(shifted, o->height * fabs(weight - o->weight[i]));
      o->weight[i] = weight;
    }
    if (length > SMALL_STEP || shifted > SMALL_STEP) continue;

    for (int i = 0, at = 0; i < 3; i++)
      for (int j = i; j < 3; j++) hessian[at++] = m[i][right + 1 + j];
    ray_gather(p, o);
    ray_vertex x;
    o->height = ray_extreme(p, o->u, &x);
    double reached = INFINITY;
    for (int i = 0; i < o->n; i++) reached = fmin(reached, vec_dot(o->u, o->corner[i].w));
    if (optimum_misses(o, p->d) <= SAME) return reached >= o->height - 1e-3 * SAME;
  }
  return false;
}

/* ---- the search ---- */

typedef enum ray_end { RAY_OPEN, RAY_NARROW, RAY_SOLVED } ray_end;

/* Solved: the conditions of the optimum, and the hessian is known. Narrow: *o is a portal that leaves hardly a choice.
 * Open: likewise, but for that, if it has corners. */
static ray_end ray_search(ray *p, ray_optimum *o, double hessian[6]) {
  ray_vertex v[RAY_CORNERS];
  *o =
      (ray_optimum){.n = 0, .u = p->d}; /* where the ray leaves M by its extreme point, portals turn round that point */
  if (!portal_open(p, v, &o->height)) return RAY_OPEN;
  const bool curved = p->a->ops->curvature || p->b->ops->curvature || p->margin_a + p->margin_b > 0.0;
  double most = o->height, next = curved ? NEWTON_FROM : 0.0, last = INFINITY;
  int stalled = 0;
  for (int i = 0; i < PORTAL_STEPS && !p->support_failed; i++) {
    vec3 u;
    feature_unit(vec_cross(vec_sub(v[1].w, v[0].w), vec_sub(v[2].w, v[0].w)), &u);
    const double along = vec_dot(u, p->d);
    ray_vertex x;
    ray_optimum now = {.n = RAY_CORNERS, .corner = {v[0], v[1], v[2]}, .u = u};
    if (!(along > 0.0) || !portal_weights(v, p->d, now.weight)) break;
    now.height = ray_extreme(p, u, &x);
    if (now.height / along < most) {
      most = fmin(now.height / along, most);
      *o = now;
    } else {
      const ray_optimum best = *o;
      *o = now;
      o->u = best.u, o->height = best.height;
    }
    const double g = now.weight[0] + now.weight[1] + now.weight[2], width = 1.0 - 1.0 / (g * most);
    if (width <= next) {
      ray_optimum solved = *o;
      if (ray_newton(p, &solved, hessian)) {
        *o = solved;
        return RAY_SOLVED;
      }
      next = width * NEWTON_AGAIN;
    }
    stalled = width < 0.9 * last ? 0 : stalled + 1;
    last = fmin(last, width);
    if (width <= CLOSED || now.height - vec_dot(u, v[0].w) <= CLOSED || (width < 1e-9 && stalled > 20)) break;
    portal_replace(v, &x, p->d);
  }
  if (o->n == 0 || p->support_failed) return RAY_OPEN;
  ray_optimum solved = *o;
  if (!ray_newton(p, &solved, hessian)) return last <= NARROW ? RAY_NARROW : RAY_OPEN;
  *o = solved;
  return RAY_SOLVED;
}

/* ---- what the optimum says ---- */

/* Whether the second derivative of the support function is known: polyhedra have none, the rest tell it. */
static bool bend_is_known(const convex *shape) {
  const cprox_body_kind kind = shape->ops->kind;
  return shape->ops->curvature || (kind != CPROX_BODY_SUPPORT && kind != CPROX_BODY_IMPLICIT);
}

/* How far the extreme points of one body spread where the direction is tilted all round, and along what. */
typedef struct ray_spread {
  vec3 along; /* unit */
  double length, across;
} ray_spread;

enum { RAY_TILTS = 8, RAY_DIRECTIONS = RAY_TILTS + 10 };

static ray_spread spread_of(const vec3 *at, int n) {
  ray_spread s = {.length = 0.0};
  vec3 longest = vec(0, 0, 0);
  for (int i = 1; i < n; i++) {
    const vec3 step = vec_sub(at[i], at[0]);
    if (vec_norm2(step) > vec_norm2(longest)) longest = step;
  }
  s.length = feature_unit(longest, &s.along);
  for (int i = 1; i < n; i++) {
    const vec3 step = vec_sub(at[i], at[0]);
    s.across = fmax(s.across, vec_norm(vec_axpy(step, -vec_dot(step, s.along), s.along)));
  }
  return s;
}

/* Whether the optimum is one alone: the bound falls in all directions that the corners and curvatures single out, and
 * not both bodies are flat along one direction. */
static void ray_alone(ray *p, const ray_optimum *o, ray_answer *answer) {
  vec3 tilt[RAY_DIRECTIONS], e, f;
  int n = 0;
  feature_tangents(o->u, &e, &f);
  for (; n < RAY_TILTS; n++) {
    const double turn = 0.785398163397448310 * n;
    tilt[n] = vec_axpy(vec_scale(cos(turn), e), sin(turn), f);
  }
  for (int i = 0; i < o->n; i++) {
    for (int j = i + 1; j < o->n; j++) {
      vec3 across;
      feature_unit(vec_cross(o->u, vec_sub(o->corner[j].w, o->corner[i].w)), &across);
      tilt[n++] = across, tilt[n++] = vec_neg(across);
    }
  }
  ray_optimum gathered = *o;
  const ray_bend k = ray_gather(p, &gathered);
  const double turn = 0.5 * atan2(2.0 * k.ef, k.ee - k.ff);
  const vec3 axis = vec_axpy(vec_scale(cos(turn), k.e), sin(turn), k.f), other = vec_cross(o->u, axis);
  tilt[n++] = axis, tilt[n++] = vec_neg(axis), tilt[n++] = other, tilt[n++] = vec_neg(other);

  vec3 on_a[RAY_DIRECTIONS], on_b[RAY_DIRECTIONS];
  const bool known = bend_is_known(p->a) && bend_is_known(p->b);
  const double by = known ? RAY_TILT : COARSER * RAY_TILT, flat = known ? RAY_FLAT : COARSER * RAY_FLAT;
  const double loss = LOSS + 2.0 * (p->a->slack + p->b->slack) / p->unit;
  const double best = vec_dot(o->u, p->d) / o->height;
  answer->slope_alone = true;
  for (int i = 0; i < n; i++) {
    ray_vertex x;
    vec3 u;
    feature_unit(vec_axpy(o->u, by, tilt[i]), &u);
    const double height = ray_extreme(p, u, &x);
    if (!(vec_dot(u, p->d) / height < best * (1.0 - loss))) answer->slope_alone = false;
    on_a[i] = vec_axpy(x.a, p->margin_a, u), on_b[i] = vec_axpy(rotate(p->r, x.b), -p->margin_b, u);
  }
  const ray_spread a = spread_of(on_a, n), b = spread_of(on_b, n);
  const double flat_a = flat * (p->a->scale + p->margin_a), flat_b = flat * (p->b->scale + p->margin_b);
  answer->point_alone = !(a.length > flat_a && b.length > flat_b) ||
                        (a.across <= flat_a && b.across <= flat_b && vec_norm(vec_cross(a.along, b.along)) > flat);
}

void ray_leave(const convex *a, double margin_a, double inner_a, const convex *b, double margin_b, double inner_b,
               const pair_placement *place, bool wants_derivatives, ray_answer *answer) {
  ray p = {.a = a, .b = b, .margin_a = margin_a, .margin_b = margin_b, .r = place->r};
  p.unit = a->scale + b->scale + margin_a + margin_b;
  const double far = feature_unit(place->t, &p.d);
  *answer = (ray_answer){.found = false};
  ray_optimum o;
  const ray_end end = ray_search(&p, &o, answer->hessian);
  answer->solved = end != RAY_OPEN;
  if (o.n > 0 && !p.support_failed) {
    /* from below by the direction: n·t over the support value; from above by the corners: their weighted mean misses
     * the ray by e, and a ball of the inner radii about 0 is in M, so that what is drawn to 0 by e in (inner + e) is */
    const double error = ROUND_UP * ((ROUND_SUPPORT + 24.0) * ROUND_U * (p.unit + far) + a->slack + b->slack +
                                     a->drawn * a->scale + b->drawn * b->scale + place->error);
    double sum = 0.0;
    vec3 mean = vec(0, 0, 0), on_a = vec(0, 0, 0);
    for (int i = 0; i < o.n; i++) {
      sum += o.weight[i];
      mean = vec_axpy(mean, o.weight[i], o.corner[i].w);
      on_a = vec_axpy(on_a, o.weight[i], o.corner[i].a);
    }
    const double e = p.unit * vec_norm(vec_sub(mean, p.d)) / sum + error, inner = inner_a + inner_b;
    const double g = sum * far / p.unit;
    answer->upper = g * (1.0 + (e + error) / inner) * (1.0 + 32.0 * ROUND_U) + error / inner;
    answer->lower = fmax(vec_dot(o.u, place->t) - error, 0.0) / (o.height * p.unit + error) * (1.0 - 8.0 * ROUND_U);
    answer->found = sum > 0.0 && isfinite(answer->upper) && answer->lower <= answer->upper;
    answer->slope = vec_scale(1.0 / (o.height * p.unit), o.u);
    answer->on_a = vec_axpy(vec_scale(1.0 / sum, on_a), margin_a, o.u);
    answer->bends = end == RAY_SOLVED && bend_is_known(a) && bend_is_known(b);
    for (int i = 0; i < 6; i++) answer->hessian[i] /= p.unit * far;
    if (answer->solved && wants_derivatives) ray_alone(&p, &o, answer);
  }
  answer->supports = p.supports;
}
