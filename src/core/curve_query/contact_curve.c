/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/contact_curve.h"

#include <math.h>

#include "curve_query/newton_steps.h"

/* ---- measuring ---- */

/* The nearer one; once there is contact, the earlier one. */
static bool is_better(const contact_curve *c, const search_best *bound) {
  const search_best *best = &c->base.best_bound;
  if (best->upper > c->epsilon) return bound->upper < best->upper;
  return bound->upper <= c->epsilon && bound->at < best->at;
}

static search_best consider(contact_curve *c, curve_meeting *m, double error) {
  curve_curve *o = &c->base;
  search_best bound = {.upper = INFINITY};
  curve_curve_measure(o, m, error, &bound);
  bound.at = curve_side_parameter_below(&o->side[0], m->piece[0], m->s[0]);
  if (bound.upper <= 0.0 && bound.at < c->proven_bound.at) {
    c->proven = *m;
    c->proven_bound = bound;
  }
  if (is_better(c, &bound)) curve_curve_adopt(o, m, bound);
  return bound;
}

/* Value and two derivatives of the loaded piece at s. */
static vec3 jet_at(const curve_side *side, double s, vec3 *first, vec3 *second) {
  const size_t degree = side->curve->degree;
  const double *x = points_pool_at(side->pool, side->root_slot), *y = x + degree + 1, *z = y + degree + 1;
  vec3 value;
  curve_bezier_evaluate(x, y, z, 1, degree, curve_binomial(side->curve), s, &value, first, second);
  return value;
}

/* A parameter of the interval at which the loaded piece is nearest to p, as far as Newton's method finds it from s: a
 * suggestion. */
static double nearest_on(const curve_side *side, const curve_interval *at, vec3 p, double s) {
  enum { MOST_STEPS = 10 };
  for (int i = 0; i < MOST_STEPS; i++) {
    vec3 first, second;
    const vec3 w = vec_sub(jet_at(side, s, &first, &second), p);
    const double slope = vec_dot(w, first), speed2 = vec_norm2(first), bend = speed2 + vec_dot(w, second);
    const double step = -slope / (bend > 0.25 * speed2 ? bend : speed2);
    const double next = fmin(fmax(s + step, at->a), at->b);
    if (!(fabs(next - s) > NEWTON_STANDS)) break; /* converged, at an end, or a curve that stands still */
    s = next;
  }
  return s;
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  curve_curve_node *payload = curve_curve_own(node);
  contact_curve *c = self;
  curve_curve *o = &c->base;
  o->nodes++;
  bool pieces;
  const cprox_status ready = curve_curve_materialise(o, node, &pieces);
  if (ready < 0) return ready;

  /* what the chords suggest, at the left end of the first interval where both are single pieces */
  double fraction[2], error;
  const vec3 suggested = curve_curve_suggest(o, node, fraction);
  curve_curve_bound(o, node, suggested);
  if (pieces) fraction[0] = 0.0;
  curve_meeting m = curve_curve_meeting_near(o, node, fraction, &error);
  c->nearest = -1.0;
  if (pieces) {
    m.s[1] = c->nearest = nearest_on(&o->side[1], &payload->side[1], m.point[0], m.s[1]);
    m.point[1] = curve_side_point(&o->side[1], m.s[1]);
  }
  consider(c, &m, error);
  if (curve_side_status(&o->side[0]) < 0) return curve_side_status(&o->side[0]);
  *best = o->best_bound;

  /* measuring at a junction may have loaded other pieces */
  for (int k = 0; k < 2; k++)
    if (payload->side[k].slot >= 0) curve_side_load(&o->side[k], curve_side_piece(&o->side[k], &payload->side[k]));
  o->last_normal = vec_norm2(m.normal) > 0.0 ? m.normal : suggested;
  curve_curve_bound(o, node, o->last_normal);
  return CPROX_OK;
}

/* ---- cutting ---- */

/* How far along the first interval, as a fraction of it, its height along the last normal stays above that of the
 * second curve's nearest point: by the line through the first Bernstein coefficient that lies below all the others. */
static double free_fraction(const contact_curve *c, const search_node *node) {
  const curve_curve *o = &c->base;
  const size_t degree = o->side[0].curve->degree;
  const double *x = points_pool_at(&o->pool, (size_t)curve_curve_known(node)->side[0].slot), *y = x + degree + 1,
               *z = y + degree + 1;
  const vec3 n = o->last_normal, start = vec(x[0], y[0], z[0]);
  if (vec_norm2(n) == 0.0) return 0.0;
  double slope = 0.0;
  const double *r = o->side[0].radius ? curve_side_radii(&o->side[0], &curve_curve_known(node)->side[0]) : NULL;
  for (size_t k = 1; k <= degree; k++) {
    const double rise = vec_dot(n, vec_sub(vec(x[k], y[k], z[k]), start)) - (r ? r[k] - r[0] : 0.0);
    slope = fmin(slope, rise * (double)degree / (double)k);
  }
  const double above = vec_dot(n, vec_sub(start, curve_side_point(&o->side[1], c->nearest))) +
                       curve_curve_carried(o, n) - (o->offset + (r ? r[0] : 0.0)) - 4.0 * node->slack;
  return slope < 0.0 ? fmin(above / -slope, 1.0) : above > 0.0 ? 1.0 : 0.0;
}

/* The first curve where its left end's free segment would end, were the second curve nowhere nearer than at its nearest
 * point, less some room for the second curve to come nearer after all; only what lies before is then worth cutting the
 * second curve for. */
static curve_curve_cuts choose_cuts(const contact_curve *c, const search_node *node) {
  const curve_curve_node *payload = curve_curve_known(node);
  const double room = 0.75, worthwhile = 0.25, inner = 0.05;
  const curve_curve *o = &c->base;
  curve_curve_cuts cuts = {.wanted = {false, false}};
  if (c->nearest < 0.0) {
    curve_curve_cut_middle(&cuts, node, curve_curve_longer_side(o, node));
    return cuts;
  }
  const curve_interval *first = &payload->side[0], *second = &payload->side[1];
  const double s = free_fraction(c, node), t = (c->nearest - second->a) / (second->b - second->a);
  if (s >= 1.0) {
    curve_curve_cut_middle(&cuts, node, 1);
    if (t > inner && t < 1.0 - inner) cuts.s[1] = t, cuts.at[1] = c->nearest;
  } else {
    curve_curve_cut_middle(&cuts, node, 0);
    if (s > worthwhile) cuts.s[0] = room * s, cuts.at[0] = first->a + room * s * (first->b - first->a);
  }
  return cuts;
}

static int split(void *self, search_node *node, search_node *child) {
  contact_curve *c = self;
  const curve_curve_cuts cuts = choose_cuts(c, node);
  const int children = curve_curve_cut(&c->base, node, &cuts, child);
  for (int k = 0; k < children; k++)
    child[k].start = curve_side_start(&c->base.side[0], &curve_curve_own(&child[k])->side[0]);
  return children;
}

/* ---- the oracle ---- */

void contact_curve_begin(contact_curve *c, double epsilon) {
  c->epsilon = epsilon;
  c->base.best_bound.at = INFINITY;
  c->proven_bound = (search_best){.upper = INFINITY, .at = INFINITY};
  c->nearest = -1.0;
}

search_node contact_curve_root(const contact_curve *c) {
  search_node root = curve_curve_root(&c->base);
  root.start = curve_side_start(&c->base.side[0], &curve_curve_own(&root)->side[0]);
  return root;
}

search_oracle contact_curve_oracle(contact_curve *c) {
  search_oracle oracle = curve_curve_oracle(&c->base); /* filter and release see the base, which is the first member */
  oracle.self = c;
  oracle.probe = probe;
  oracle.split = split;
  return oracle;
}

void contact_curve_prove(contact_curve *c) {
  enum { MOST_STEPS = 12 };
  curve_curve *o = &c->base;
  search_best bound = o->best_bound;
  if (!(bound.upper <= c->epsilon) || c->proven_bound.at <= bound.at) return;

  /* Newton's method along the first curve, aimed as deep as rounding could hide contact; the second follows */
  const double found_at = c->proven_bound.at;
  curve_meeting m = o->best;
  for (int k = 0; k < 2; k++) curve_side_load(&o->side[k], m.piece[k]);
  const curve_interval whole = {.a = 0.0, .b = 1.0};
  for (int i = 0; i < MOST_STEPS && c->proven_bound.at == found_at; i++) {
    vec3 velocity, unused;
    jet_at(&o->side[0], m.s[0], &velocity, &unused);
    const double thickens = curve_side_thickness(&o->side[0], m.piece[0], m.s[0]).slope;
    const double inward = thickens - vec_dot(m.normal, velocity),
                 s = m.s[0] + (bound.upper + 2.0 * bound.slack) / inward;
    if (!(inward > 0.0 && s > m.s[0] && m.s[0] < 1.0)) return;
    m.s[0] = fmin(s, 1.0);
    m.point[0] = curve_side_point(&o->side[0], m.s[0]);
    m.s[1] = nearest_on(&o->side[1], &whole, m.point[0], m.s[1]);
    m.point[1] = curve_side_point(&o->side[1], m.s[1]);
    bound = consider(c, &m, curve_side_point_error(&o->side[0]) + curve_side_point_error(&o->side[1]));
  }
}
