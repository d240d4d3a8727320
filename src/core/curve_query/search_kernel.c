/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/search_kernel.h"

#include "base/rounding.h"
#include "curve/relative_curve.h"
#include "curve_query/crossing.h"
#include "problem/carried_shape.h"
#include "problem/radius.h"
#include "shape/body.h"

/* ---- what the kernels share ---- */

/* Easy verdicts are answered before Newton has paid for itself. */
static search_effort effort_of(const query *q) {
  enum { VERDICT_NODES_BEFORE_NEWTON = 4 };
  const bool verdict = query_wants_verdict(q);
  return (search_effort){.newton_after = verdict ? VERDICT_NODES_BEFORE_NEWTON : 0,
                         .is_signed = q->is_signed,
                         .good_enough = q->is_signed ? -INFINITY
                                        : verdict    ? q->limit
                                                     : q->options.epsilon,
                         .epsilon = q->options.epsilon};
}

/* The curve that a search runs along, about the obstacle: synchronized it is where the mover is, seen from the other.
 * Where the radius changes, that too, with the same pieces. */
typedef struct search_way {
  const cprox_curve *curve, *radius; /* radius: NULL where it does not change */
  cprox_curve made[2];               /* the two, where they were made for this search */
} search_way;

/* The curve whose x is what both radii add to their constant parts: the sum of two is the difference from the second
 * one after half a turn about z. */
static const cprox_curve *radius_about(const query *q, const placed_pair *p, cprox_curve *sum) {
  static const cprox_pose HALF_TURN = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}};
  const cprox_curve *own = q->mover.radius_curve, *other = p->obstacle->radius_curve;
  if (!own || !other) return own ? own : other;
  return relative_create(own, other, &HALF_TURN, q->t0, q->t1, q->workspace, WORKSPACE_RADII, sum) ? sum : NULL;
}

/* False where memory is out. */
static bool way_begin(const query *q, const placed_pair *p, search_way *way) {
  const cprox_obstacle *obstacle = p->obstacle;
  way->curve = q->mover.curve, way->radius = NULL;
  if (obstacle->synchronized) {
    way->curve = &way->made[0];
    if (!relative_create(q->mover.curve, obstacle->curve, &obstacle->pose, q->t0, q->t1, q->workspace,
                         WORKSPACE_RELATIVE, &way->made[0]))
      return false;
  }
  if (!p->radius_changes) return true;
  cprox_curve sum, centres;
  const cprox_curve *radius = radius_about(q, p, &sum);
  if (!radius || !relative_align(way->curve, radius, q->t0, q->t1, q->workspace, WORKSPACE_ALIGNED, &centres) ||
      !relative_align(radius, way->curve, q->t0, q->t1, q->workspace, WORKSPACE_ALIGNED_RADII, &way->made[1]))
    return false;
  way->made[0] = centres;
  way->curve = &way->made[0], way->radius = &way->made[1];
  return true;
}

/* The search owns what was made for it, which is all of it; of another curve it sees the part in query. */
static bool way_keep(const query *q, const search_way *way, cprox_curve own[2], curve_side *side) {
  side->part = q->part;
  if (way->curve != &way->made[0]) return true;
  own[0] = way->made[0];
  side->curve = &own[0];
  side->part = curve_side_whole();
  if (!way->radius) return true;
  own[1] = way->made[1];
  return curve_side_thicken(side, &own[1]);
}

static void begin_finding(curve_finding *seen, bool found, const search_best *bound, uint32_t distance_queries) {
  seen->found = found;
  seen->is_contact = seen->at_end = seen->parts_known = false;
  seen->t_obstacle = NAN;
  seen->bound = *bound;
  seen->distance_queries = distance_queries;
}

/* ---- a convex shape ---- */

/* A carried body and what stands make one shape. */
static bool begin_carried(const query *q, const placed_pair *p, const cprox_curve *curve, curve_convex *o) {
  carried_shape joined = {.placed = p->frame};
  if (!carried_shape_join(p->shape, &p->pose, p->carried, &p->carried_pose, &joined)) return false;
  joined.shape.slack += p->position_error, joined.shape.outside += p->position_error;
  const double offset = p->offset + joined.offset;
  if (!curve_convex_begin(o, curve, &p->shape->shape, joined.placed, offset, q->workspace)) return false;
  o->joined = joined.shape;
  o->shape = &o->joined;
  return true;
}

/* The shape that stands for both, along a curve that is seen from what stands. */
static bool begin_along(const query *q, const placed_pair *p, const cprox_curve *curve, curve_convex *o) {
  if (q->mover.body) return begin_carried(q, p, curve, o);
  return curve_convex_begin(o, curve, &p->shape->shape, p->frame, p->offset, q->workspace);
}

bool curve_convex_begin_pair(curve_convex *o, const query *q, const placed_pair *p) {
  search_way way;
  return way_begin(q, p, &way) && begin_along(q, p, way.curve, o) && way_keep(q, &way, o->own, &o->side);
}

static cprox_status begin_convex(curve_search *s) {
  return curve_convex_begin_pair(&s->state.convex.base, s->q, s->pair) ? CPROX_OK : CPROX_MEMORY;
}

static cprox_status start_convex(curve_search *s, curve_start *start) {
  curve_convex *o = &s->state.convex.base;
  const query *q = s->q;
  const candidate *which = &s->pair->which;
  o->effort = effort_of(q);
  start->oracle = curve_convex_oracle(o);
  start->root = curve_convex_root(o);
  if (!(which->seed_s > 0.0) || o->side.radius) return CPROX_OK; /* seeds are about the mover's own pieces */
  const cprox_status seeded = curve_convex_seed(o, which->seed_piece, which->seed_s, &start->root);
  start->upper = o->best_bound.upper;
  return seeded;
}

/* The sides of a flat body may prove it. */
static bool prove_crossing_convex(curve_search *s) {
  curve_convex *o = &s->state.convex.base;
  const double upper = o->best_bound.upper;
  if (s->q->limit != 0.0 || !(upper > 0.0 && upper <= s->q->options.epsilon)) return false;
  curve_sample sample = o->best;
  crossing_place place;
  if (!crossing_prove_convex(o, &sample, &place)) return false;
  curve_convex_adopt(o, &sample, (search_best){.upper = 0.0, .slack = o->best_bound.slack});
  return true;
}

static cprox_status start_contact_convex(curve_search *s, curve_start *start) {
  contact_convex *c = &s->state.convex;
  contact_convex_begin(c, s->q->options.epsilon);
  start->oracle = contact_convex_oracle(c);
  start->root = contact_convex_root(c);
  return CPROX_OK;
}

static cprox_status prove_contact_convex(curve_search *s, curve_finding *proven) {
  contact_convex *c = &s->state.convex;
  const cprox_status status = contact_convex_prove(c);
  if (status < 0) return status;
  begin_finding(proven, false, &c->proven_bound, c->base.distance_queries);
  if (isinf(c->proven_bound.at)) return CPROX_OK;
  c->base.best = c->proven;
  curve_convex_finding(&c->base, proven);
  proven->bound = c->proven_bound;
  proven->is_contact = true;
  if (vec_norm2(proven->normal) == 0.0) proven->normal = frame_turn_to_world(&c->base.side.frame, c->proven.normal);
  if (c->proven_within) proven->t_contact = c->proven_t;
  return CPROX_OK;
}

void curve_convex_finding(const curve_convex *o, curve_finding *seen) {
  const curve_sample *best = &o->best;
  const frame *f = &o->side.frame;
  begin_finding(seen, o->incumbent > 0, &o->best_bound, o->distance_queries);
  if (!seen->found) return;
  const bool is_normal = vec_norm2(best->near.normal) != 0.0; /* else it is only one to bound by */
  seen->at_end = best->s == 1.0;
  seen->t = seen->t_contact = curve_side_parameter(&o->side, best->piece, best->s);
  seen->centre = frame_to_world(f, best->y);
  seen->surface = frame_to_world(f, best->near.point);
  seen->normal = is_normal ? frame_turn_to_world(f, best->normal) : vec(0, 0, 0);
  seen->distance = best->near.distance;
  seen->parts_known = best->near.parts_known;
  seen->on_standing = seen->parts_known ? best->near.on_standing : best->near.point;
  seen->on_carried = seen->parts_known ? best->near.on_carried : best->y;
}

static void found_convex(const curve_search *s, curve_finding *seen) {
  curve_convex_finding(&s->state.convex.base, seen);
}

/* ---- the elements of a BVH ---- */

bool curve_tree_begin_pair(curve_tree *o, const query *q, const placed_pair *p) {
  search_way way;
  return way_begin(q, p, &way) && curve_tree_begin(o, way.curve, p->shape, p->frame, p->offset, q->workspace) &&
         way_keep(q, &way, o->own, &o->side);
}

static cprox_status begin_tree(curve_search *s) {
  return curve_tree_begin_pair(&s->state.tree.base, s->q, s->pair) ? CPROX_OK : CPROX_MEMORY;
}

static cprox_status start_tree(curve_search *s, curve_start *start) {
  curve_tree *o = &s->state.tree.base;
  if (!curve_tree_root(o, &start->root)) return CPROX_MEMORY;
  start->goal.order = SEARCH_DEPTH_FIRST; /* lists of elements are kept on a stack */
  o->asked = start->goal;
  o->effort = effort_of(s->q);
  start->oracle = curve_tree_oracle(o);
  return CPROX_OK;
}

static cprox_status start_contact_tree(curve_search *s, curve_start *start) {
  contact_tree *c = &s->state.tree;
  c->base.asked = start->goal;
  if (!contact_tree_begin(c, &start->root)) return CPROX_MEMORY;
  start->oracle = contact_tree_oracle(c);
  return CPROX_OK;
}

static cprox_status prove_contact_tree(curve_search *s, curve_finding *proven) {
  contact_tree *c = &s->state.tree;
  contact_tree_prove(c);
  begin_finding(proven, false, &c->proven_bound, c->base.distance_queries);
  if (isinf(c->proven_bound.at)) return CPROX_OK;
  c->base.best = c->proven;
  curve_tree_finding(&c->base, proven);
  proven->bound = c->proven_bound;
  if (c->proven_within) proven->t_contact = c->proven_t;
  return CPROX_OK;
}

void curve_tree_finding(const curve_tree *o, curve_finding *seen) {
  const tree_sample *best = &o->best;
  const frame *f = &o->side.frame;
  const double margin = o->body->shape.margin;
  begin_finding(seen, o->found, &o->best_bound, o->distance_queries);
  if (!seen->found) return;
  seen->at_end = best->s == 1.0;
  seen->t = seen->t_contact = curve_side_parameter(&o->side, best->piece, best->s);
  seen->centre = frame_to_world(f, best->y);
  seen->surface = frame_to_world(f, vec_axpy(best->near.point, margin, best->near.normal));
  seen->normal = frame_turn_to_world(f, best->near.normal);
  seen->distance = best->near.distance - margin;
}

static void found_tree(const curve_search *s, curve_finding *seen) {
  curve_tree_finding(&s->state.tree.base, seen);
}

/* ---- another curve ---- */

static cprox_status begin_curve(curve_search *s) {
  curve_curve *o = &s->state.curve.base;
  const query *q = s->q;
  const placed_pair *p = s->pair;
  const cprox_pose *pose = &p->obstacle->pose;
  search_way way;
  if (!way_begin(q, p, &way) || !curve_curve_begin(o, way.curve, p->obstacle->curve, pose, p->offset, q->workspace) ||
      !way_keep(q, &way, o->own, &o->side[0]))
    return CPROX_MEMORY;
  return !p->carried || curve_curve_carry(o, pose, p->carried, &p->carried_pose) ? CPROX_OK : CPROX_MEMORY;
}

static cprox_status start_curve(curve_search *s, curve_start *start) {
  curve_curve *o = &s->state.curve.base;
  o->effort = effort_of(s->q);
  start->oracle = curve_curve_oracle(o);
  start->root = curve_curve_root(o);
  return CPROX_OK;
}

static cprox_status start_contact_curve(curve_search *s, curve_start *start) {
  contact_curve *c = &s->state.curve;
  contact_curve_begin(c, s->q->options.epsilon);
  start->oracle = contact_curve_oracle(c);
  start->root = contact_curve_root(c);
  return CPROX_OK;
}

static void found_curve(const curve_search *s, curve_finding *seen) {
  const curve_curve *o = &s->state.curve.base;
  const curve_meeting *best = &o->best;
  const frame *f = &o->side[0].frame;
  begin_finding(seen, o->incumbent > 0, &o->best_bound, o->distance_queries);
  if (!seen->found) return;
  seen->t = seen->t_contact = curve_side_parameter(&o->side[0], best->piece[0], best->s[0]);
  seen->t_obstacle = curve_side_parameter(&o->side[1], best->piece[1], best->s[1]);
  seen->centre = frame_to_world(f, best->point[0]);
  seen->surface = frame_to_world(f, best->point[1]);
  seen->normal = frame_turn_to_world(f, best->normal);
  seen->distance = best->distance;
}

static cprox_status prove_contact_curve(curve_search *s, curve_finding *proven) {
  contact_curve *c = &s->state.curve;
  contact_curve_prove(c);
  begin_finding(proven, false, &c->proven_bound, c->base.distance_queries);
  if (isinf(c->proven_bound.at)) return CPROX_OK;
  c->base.best = c->proven;
  found_curve(s, proven);
  proven->bound = c->proven_bound;
  return CPROX_OK;
}

/* ---- a set known by its distance ---- */

static cprox_status begin_field(curve_search *s) {
  curve_distance *o = &s->state.distance;
  const placed_pair *p = s->pair;
  search_way way;
  const bool begun =
      way_begin(s->q, p, &way) &&
      curve_distance_begin(o, way.curve, p->shape, p->frame, p->offset, s->q->options.epsilon, s->q->workspace) &&
      way_keep(s->q, &way, o->own, &o->side);
  return begun ? CPROX_OK : CPROX_MEMORY;
}

static cprox_status start_field(curve_search *s, curve_start *start) {
  curve_distance *o = &s->state.distance;
  start->oracle = curve_distance_oracle(o);
  start->root = curve_distance_root(o);
  return CPROX_OK;
}

static cprox_status start_contact_field(curve_search *s, curve_start *start) {
  curve_distance_begin_contact(&s->state.distance);
  return start_field(s, start);
}

static void find_sample(const curve_distance *o, const distance_sample *sample, curve_finding *seen) {
  const frame *f = &o->side.frame;
  vec3 normal;
  const vec3 nearest = distance_field_nearest(o->body->field, &sample->seen, &normal);
  seen->at_end = sample->s == 1.0;
  seen->t = seen->t_contact = curve_side_parameter(&o->side, sample->piece, sample->s);
  seen->centre = frame_to_world(f, sample->y);
  seen->surface = frame_to_world(f, vec_sub(nearest, o->body->centre));
  seen->normal = frame_turn_to_world(f, normal);
  seen->distance = sample->seen.value;
}

static void found_field(const curve_search *s, curve_finding *seen) {
  const curve_distance *o = &s->state.distance;
  begin_finding(seen, o->found, &o->best_bound, o->distance_queries);
  if (seen->found) find_sample(o, &o->best, seen);
}

static cprox_status prove_contact_field(curve_search *s, curve_finding *proven) {
  const curve_distance *o = &s->state.distance;
  begin_finding(proven, isfinite(o->proven_bound.at), &o->proven_bound, o->distance_queries);
  if (proven->found) find_sample(o, &o->proven, proven);
  return CPROX_OK;
}

/* ---- the rows ---- */

static const curve_kernel convex_kernel = {.knows_depth = true,
                                           .begin_state = begin_convex,
                                           .start_distance = start_convex,
                                           .start_contact = start_contact_convex,
                                           .prove_crossing = prove_crossing_convex,
                                           .prove_contact = prove_contact_convex,
                                           .best_found = found_convex};

static const curve_kernel tree_kernel = {.begin_state = begin_tree,
                                         .start_distance = start_tree,
                                         .start_contact = start_contact_tree,
                                         .prove_contact = prove_contact_tree,
                                         .best_found = found_tree};

static const curve_kernel two_curves_kernel = {.knows_depth = true,
                                               .begin_state = begin_curve,
                                               .start_distance = start_curve,
                                               .start_contact = start_contact_curve,
                                               .prove_contact = prove_contact_curve,
                                               .best_found = found_curve};

static const curve_kernel field_kernel = {.begin_state = begin_field,
                                          .start_distance = start_field,
                                          .start_contact = start_contact_field,
                                          .prove_contact = prove_contact_field,
                                          .best_found = found_field};

const curve_kernel *curve_kernel_of(const placed_pair *p) {
  if (!p->shape) return &two_curves_kernel;
  if (p->shape->field) return &field_kernel;
  return p->shape->tree ? &tree_kernel : &convex_kernel;
}

cprox_status curve_kernel_shortfall(const placed_pair *p, double slack) {
  const bool by_field = p->shape && p->shape->field && p->shape->field->error > slack; /* which has half of it */
  return by_field ? CPROX_INEXACT : CPROX_PRECISION;
}

cprox_status curve_search_begin(curve_search *s, const query *q, const placed_pair *p) {
  s->q = q;
  s->pair = p;
  s->kernel = curve_kernel_of(p);
  return s->kernel->begin_state(s);
}
