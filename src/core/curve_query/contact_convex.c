/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/contact_convex.h"

#include <math.h>

#include "base/rounding.h"
#include "curve/control.h"
#include "curve_query/crossing.h"

/* ---- measuring ---- */

/* The nearer one; once there is contact, the earlier one. */
static bool is_better(const contact_convex *c, const search_best *bound) {
  const search_best *best = &c->base.best_bound;
  if (best->upper > c->epsilon) return bound->upper < best->upper;
  return bound->upper <= c->epsilon && bound->at < best->at;
}

/* Measures at a point of the curve; the sample stands in base.last. */
static cprox_status measure(contact_convex *c, size_t piece, double s, vec3 y, double error, search_best *bound) {
  curve_convex *o = &c->base;
  const cprox_status status = curve_convex_measure(o, piece, s, y, error, &o->last, bound);
  if (status < 0) return status;
  bound->at = curve_side_parameter_below(&o->side, piece, s);
  if (bound->upper <= 0.0 && bound->at < c->proven_bound.at) {
    c->proven = o->last;
    c->proven_bound = *bound;
  }
  if (is_better(c, bound)) curve_convex_adopt(o, &o->last, *bound);
  return CPROX_OK;
}

/* Intervals are measured at their left end, ranges of pieces where they fall in two. */
static cprox_status probe(void *self, search_node *node, search_best *best) {
  contact_convex *c = self;
  curve_convex *o = &c->base;
  curve_interval *at = &curve_convex_own(node)->at;
  o->nodes++;
  size_t piece;
  double s, error;
  vec3 y;
  if (curve_side_is_piece(&o->side, at)) {
    if (!curve_side_materialise(&o->side, at)) return curve_side_failure(&o->side);
    const size_t stride = o->side.curve->degree + 1;
    const double *points = points_pool_at(&o->pool, (size_t)at->slot);
    piece = curve_side_piece(&o->side, at), s = at->a, error = at->error;
    y = vec(points[0], points[stride], points[2 * stride]);
  } else {
    y = curve_side_junction(&o->side, at, &piece, &s, &error);
  }
  search_best bound = {.upper = INFINITY};
  const cprox_status status = measure(c, piece, s, y, error, &bound);
  if (status < 0) return status;
  *best = o->best_bound;
  curve_convex_bound(o, node, &o->last);
  return CPROX_OK;
}

/* ---- cutting ---- */

/* How far along the interval, as a fraction of it, the distance is above 0 by the normal of its left end: the line
 * through the first Bernstein coefficient of n·psi - h that lies below all the others. */
static double free_fraction(const contact_convex *c, const search_node *node) {
  const curve_convex *o = &c->base;
  const size_t degree = o->side.curve->degree;
  const double *x = points_pool_at(&o->pool, (size_t)curve_convex_known(node)->at.slot), *y = x + degree + 1,
               *z = y + degree + 1;
  const vec3 n = o->last.normal;
  const double first = vec_dot(n, vec(x[0], y[0], z[0]));
  double slope = 0.0;
  for (size_t k = 1; k <= degree; k++) {
    const double rise = vec_dot(n, vec(x[k], y[k], z[k])) - first;
    slope = fmin(slope, rise * (double)degree / (double)k);
  }
  const double above = first - o->last.support - 4.0 * node->slack;
  return slope < 0.0 && isfinite(above) ? above / -slope : 0.0;
}

static void begin_child(contact_convex *c, search_node *child, const search_node *node, curve_interval at) {
  curve_convex_node *payload = curve_convex_own(child);
  *child = *node;
  payload->at = at;
  child->start = curve_side_start(&c->base.side, &at);
  payload->seen = payload->seen_ball = 0;
  curve_convex_bound(&c->base, child, &c->base.last);
}

static int split(void *self, search_node *node, search_node *child) {
  enum { SHORTEST_STEP = 4 }; /* free segments below 1/4 are not worth a cut of their own */
  contact_convex *c = self;
  curve_convex *o = &c->base;
  curve_interval *at = &curve_convex_own(node)->at, half[2];
  if (!curve_side_is_piece(&o->side, at)) {
    curve_side_cut_range(at, half);
  } else {
    const double fraction = free_fraction(c, node);
    const double s = fraction * SHORTEST_STEP > 1.0 && fraction < 1.0 ? fraction : 0.5;
    const double cut = at->a + s * (at->b - at->a);
    if (!(at->a < cut && cut < at->b)) return 0;
    if (!curve_side_cut_piece(&o->side, at, cut, s, half)) return curve_side_failure(&o->side);
  }
  int children = 0;
  for (int k = 0; k < 2; k++)
    if (!curve_side_is_empty(&o->side, &half[k])) begin_child(c, &child[children++], node, half[k]);
  return children;
}

/* ---- the oracle ---- */

void contact_convex_begin(contact_convex *c, double epsilon) {
  c->epsilon = epsilon;
  c->base.best_bound.at = INFINITY;
  c->proven_bound = (search_best){.upper = INFINITY, .at = INFINITY};
  c->proven_within = false;
}

search_node contact_convex_root(const contact_convex *c) {
  search_node root = curve_convex_root(&c->base);
  root.start = curve_side_start(&c->base.side, &curve_convex_own(&root)->at);
  return root;
}

search_oracle contact_convex_oracle(contact_convex *c) {
  search_oracle oracle = curve_convex_oracle(&c->base); /* filter and release see the base, which is the first member */
  oracle.self = c;
  oracle.probe = probe;
  oracle.split = split;
  return oracle;
}

/* How fast the curve goes into the body at a sample, by the piece's own parameter; <= 0: it does not. */
static double inward_speed(curve_convex *o, const curve_sample *sample) {
  curve_side_load(&o->side, sample->piece);
  const size_t degree = o->side.curve->degree;
  const double *x = points_pool_at(&o->pool, o->side.root_slot), *y = x + degree + 1, *z = y + degree + 1;
  vec3 velocity;
  curve_bezier_evaluate(x, y, z, 1, degree, o->side.curve->binomial, sample->s, NULL, &velocity, NULL);
  return -vec_dot(sample->normal, velocity);
}

cprox_status contact_convex_prove(contact_convex *c) {
  enum { MOST_STEPS = 12 };
  curve_convex *o = &c->base;
  search_best bound = o->best_bound;
  if (!(bound.upper <= c->epsilon) || c->proven_bound.at <= bound.at) return CPROX_OK;

  /* Newton's method on the distance, aimed as deep below the surface as rounding could hide it */
  const double found_at = c->proven_bound.at;
  curve_sample sample = o->best;
  for (int i = 0; i < MOST_STEPS && c->proven_bound.at == found_at; i++) {
    const double inward = inward_speed(o, &sample);
    if (!(inward > 0.0)) break;
    double next = sample.s + (bound.upper + 2.0 * bound.slack) / inward;
    size_t piece = sample.piece;
    if (next >= 1.0 && piece + 1 < o->side.curve->n_pieces) piece++, next = 0.0;
    if (piece == sample.piece && !(next > sample.s)) break;
    curve_side_load(&o->side, piece);
    next = fmin(next, 1.0);
    const cprox_status status =
        measure(c, piece, next, curve_side_point(&o->side, next), curve_side_point_error(&o->side), &bound);
    if (status < 0) return status;
    sample = o->last;
  }
  crossing_place place;
  if (c->proven_bound.at < found_at || !crossing_prove_convex(o, &sample, &place)) return CPROX_OK;

  /* through a flat body, which nothing lies below the surface of */
  c->proven_t = curve_side_parameter(&o->side, place.until_piece, place.until);
  bound = (search_best){.upper = 0.0, .at = c->proven_t};
  c->proven_within = bound.at < found_at;
  if (c->proven_within) c->proven = sample, c->proven_bound = bound;
  return CPROX_OK;
}
