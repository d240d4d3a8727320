/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/contact_convex.h"

#include <math.h>

#include "base/rounding.h"
#include "curve/control.h"
#include "curve_query/crossing.h"

/* How exactly distances are measured, as a fraction of them: steps fall that much short of contact. */
static const double ROUGH = 1e-6;

/* ---- measuring ---- */

/* The nearer one; once there is contact, the earlier one. */
static bool is_better(const contact_convex *c, const search_best *bound) {
  const search_best *best = &c->base.best_bound;
  if (best->upper > c->epsilon) return bound->upper < best->upper;
  return bound->upper <= c->epsilon && bound->at < best->at;
}

/* Measures at a point of the curve; the sample stands in base.last. Where a measurement has no normal the one before
 * says where the surface is. */
static cprox_status measure(contact_convex *c, size_t piece, double s, vec3 y, double error, search_best *bound) {
  curve_convex *o = &c->base;
  const vec3 before = o->hint.towards = o->last.normal;
  o->settled = vec_norm2(before) > 0.0 ? c->epsilon : 0.0;
  if (o->side.radius) o->hint.floor = o->offset + curve_side_thickness(&o->side, piece, s).value;
  const cprox_status status = curve_convex_measure(o, piece, s, y, error, &o->last, bound);
  if (status < 0) return status;
  if (!(vec_norm2(o->last.normal) > 0.0)) o->last.normal = before;
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

/* How near a plane is followed, as a fraction of epsilon: contact is measured there, and what is before is known to
 * keep nearly as much. */
static const double FOLLOWED = 0.5, KEPT = 0.49;

/* Where the line through c_0 > 0 that lies below all other points (k / degree, c_k) comes down to 0, as a fraction of
 * the interval; infinity: nowhere. The polynomial with these Bernstein coefficients is above 0 before. */
static double line_crossing(const double *c, size_t degree) {
  double fall = 0.0, over = 1.0;
  for (size_t k = 1; k <= degree; k++) {
    const double by = c[0] - c[k];
    if (by * over > fall * (double)k) fall = by, over = (double)k;
  }
  return fall > 0.0 ? c[0] * over / (fall * (double)degree) : INFINITY;
}

/* Cuts the coefficients at s: c becomes those of [0, s], right those of [s, 1]. Either may be too high by rounding, so
 * both are lowered by that. */
static void cut_coefficients(double *c, double *right, size_t degree, double s) {
  double most = 0.0;
  for (size_t k = 0; k <= degree; k++) {
    right[k] = c[k];
    most = greater(fabs(c[k]), most);
  }
  const double error = ROUND_UP * 6.0 * (double)degree * ROUND_U * most;
  for (size_t level = 1; level <= degree; level++) {
    for (size_t k = 0; k + level <= degree; k++) right[k] += s * (right[k + 1] - right[k]);
    c[level] = right[0];
  }
  for (size_t k = 0; k <= degree; k++) c[k] -= error, right[k] -= error;
}

/* How far the polynomial of these coefficients is certainly above 0, as a fraction of the interval: a window [from, to]
 * closes on its first root. Its part before the line's crossing is cut off at the left; where that is little, most of
 * the rest is laid by first, and looked at where what is before it is all free. */
static double first_root(double *c, size_t degree) {
  enum { ROUNDS = 24 };
  static const double SLOW = 0.25, LEFT = 1e-10;
  const double enough = LEFT * c[0];
  double from = 0.0, to = 1.0, other[CPROX_MAX_DEGREE + 1] = {0}, end = 1.0;
  for (int round = 0; round < ROUNDS && c[0] > enough; round++) {
    const double gain = line_crossing(c, degree);
    if (!(gain < 1.0 - 1e-12)) {
      from = to;
      if (!(to < end)) return from;
      for (size_t k = 0; k <= degree; k++) c[k] = other[k];
      to = end;
      continue;
    }
    if (gain < SLOW) {
      const double share = lesser(2.0 * gain, 0.5);
      cut_coefficients(c, other, degree, share);
      end = to, to = from + share * (to - from);
      continue;
    }
    double right[CPROX_MAX_DEGREE + 1];
    const double step = gain * (to - from);
    cut_coefficients(c, right, degree, gain);
    for (size_t k = 0; k <= degree; k++) c[k] = right[k];
    from += step;
  }
  return from;
}

/* How far along the interval, as a fraction of it, the distance is above FOLLOWED epsilon by the normal of its left
 * end: as far as the polynomial n·psi - h is. 1: all the way. */
static double free_fraction(const contact_convex *c, const search_node *node) {
  const curve_convex *o = &c->base;
  const size_t degree = o->side.curve->degree;
  const double *x = points_pool_at(&o->pool, (size_t)curve_convex_known(node)->at.slot), *y = x + degree + 1,
               *z = y + degree + 1;
  const vec3 n = o->last.normal;
  double rest[CPROX_MAX_DEGREE + 1];
  for (size_t k = 0; k <= degree; k++)
    rest[k] = vec_dot(n, vec(x[k], y[k], z[k])) - o->last.support - 4.0 * node->slack - FOLLOWED * c->epsilon;
  if (o->side.radius) {
    const double *r = curve_side_radii(&o->side, &curve_convex_known(node)->at);
    for (size_t k = 0; k <= degree; k++) rest[k] -= r[k];
  }
  if (!isfinite(rest[0])) return 0.0;
  const double root = first_root(rest, degree);
  return root < 1.0 ? (1.0 - 1e-12) * root : 1.0; /* ends of windows are rounded */
}

static void begin_child(contact_convex *c, search_node *child, const search_node *node, curve_interval at) {
  curve_convex_node *payload = curve_convex_own(child);
  *child = *node;
  payload->at = at;
  child->start = curve_side_start(&c->base.side, &at);
  payload->seen = payload->seen_ball = 0;
  curve_convex_bound(&c->base, child, &c->base.last);
}

/* Where cuts of cuts have made points too inexact they are cut from those of the piece again, when they are wanted. */
static void make_exact(const contact_convex *c, curve_interval *at) {
  const curve_side *side = &c->base.side;
  const double fresh = side->root_error + 64.0 * (double)side->curve->degree * ROUND_U * side->root_magnitude;
  if (side->curve->arcs || !(at->error > fresh)) return;
  points_pool_release(side->pool, at->slot);
  at->slot = -1;
}

/* Free as far as `fraction`, which leaves at once; what follows falls in two where that is short, so that what lies
 * farther along is not bounded from here. */
static int split_free(contact_convex *c, search_node *node, double fraction, search_node *child) {
  static const double SHORT = 1.0 / 16;
  curve_side *side = &c->base.side;
  curve_interval *at = &curve_convex_own(node)->at, half[2], quarter[2];
  const double cut = at->a + fraction * (at->b - at->a);
  if (!(at->a < cut && cut < at->b)) return 0;
  if (!curve_side_cut_piece(side, at, cut, fraction, half)) return curve_side_failure(side);
  begin_child(c, &child[0], node, half[0]);
  if (!side->curve->arcs)
    child[0].lower =
        greater(child[0].lower, greater(KEPT * c->epsilon, 1e-300)); /* arcs leave the hull of their points */
  const double s = 4.0 * fraction, middle = half[1].a + s * (half[1].b - half[1].a);
  make_exact(c, &half[1]);
  if (fraction > SHORT || half[1].slot < 0 || !(half[1].a < middle && middle < half[1].b)) {
    begin_child(c, &child[1], node, half[1]);
    return 2;
  }
  if (!curve_side_cut_piece(side, &half[1], middle, s, quarter)) return curve_side_failure(side);
  begin_child(c, &child[1], node, quarter[0]);
  begin_child(c, &child[2], node, quarter[1]);
  return 3;
}

static int split(void *self, search_node *node, search_node *child) {
  contact_convex *c = self;
  curve_convex *o = &c->base;
  curve_interval *at = &curve_convex_own(node)->at, half[2];
  if (!curve_side_is_piece(&o->side, at)) {
    curve_side_cut_range(at, half);
  } else {
    const double fraction = free_fraction(c, node);
    if (fraction > 0.0 && fraction < 1.0) {
      const int children = split_free(c, node, fraction, child);
      if (children != 0) return children;
    }
    const double cut = at->a + 0.5 * (at->b - at->a);
    if (!(at->a < cut && cut < at->b)) return 0;
    if (!curve_side_cut_piece(&o->side, at, cut, 0.5, half)) return curve_side_failure(&o->side);
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
  c->base.hint.fraction = ROUGH, c->base.hint.floor = c->base.offset;
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
  curve_bezier_evaluate(x, y, z, 1, degree, curve_binomial(o->side.curve), sample->s, NULL, &velocity, NULL);
  return curve_side_thickness(&o->side, sample->piece, sample->s).slope - vec_dot(sample->normal, velocity);
}

/* From the best sample on, Newton's method on the distance, aimed below the surface by so many times what rounding
 * could hide. *sample becomes the last one. */
static cprox_status prove_below(contact_convex *c, double deep, curve_sample *sample) {
  enum { MOST_STEPS = 12 };
  curve_convex *o = &c->base;
  search_best bound = o->best_bound;
  const double found_at = c->proven_bound.at;
  *sample = o->best;
  for (int i = 0; i < MOST_STEPS && c->proven_bound.at == found_at; i++) {
    const double inward = inward_speed(o, sample);
    if (!(inward > 0.0)) break;
    double next = sample->s + (bound.upper + deep * bound.slack) / inward;
    size_t piece = sample->piece;
    if (next >= 1.0 && piece + 1 < o->side.curve->n_pieces) piece++, next = 0.0;
    if (piece == sample->piece && !(next > sample->s)) break;
    curve_side_load(&o->side, piece);
    next = fmin(next, 1.0);
    o->last.normal = sample->normal;
    const cprox_status status =
        measure(c, piece, next, curve_side_point(&o->side, next), curve_side_point_error(&o->side), &bound);
    if (status < 0) return status;
    *sample = o->last;
  }
  return CPROX_OK;
}

cprox_status contact_convex_prove(contact_convex *c) {
  /* a depth of a few roundings is costly to prove, and 0 in what is thinner */
  static const double DEEP = 64.0, BARELY_DEEP = 2.0;
  curve_convex *o = &c->base;
  if (!(o->best_bound.upper <= c->epsilon) || c->proven_bound.at <= o->best_bound.at) return CPROX_OK;
  const double found_at = c->proven_bound.at;
  curve_sample sample;
  cprox_status status = CPROX_OK;
  if (o->shape->ops->proves_depth) status = prove_below(c, DEEP, &sample);
  if (status == CPROX_OK && c->proven_bound.at == found_at) status = prove_below(c, BARELY_DEEP, &sample);
  if (status < 0) return status;
  crossing_place place;
  if (c->proven_bound.at < found_at || !crossing_prove_convex(o, &sample, &place)) return CPROX_OK;

  /* through a flat body, which nothing lies below the surface of */
  c->proven_t = curve_side_parameter(&o->side, place.until_piece, place.until);
  const search_best bound = {.upper = 0.0, .at = c->proven_t};
  c->proven_within = bound.at < found_at;
  if (c->proven_within) c->proven = sample, c->proven_bound = bound;
  return CPROX_OK;
}
