/* SPDX-License-Identifier: BSD-3-Clause */
/* One search: the engine with the oracle that the candidate asks for, and what it found in the terms of the caller. */
#include "curve_query/search_pair.h"
#include "base/rounding.h"
#include "curve/relative_curve.h"
#include "curve_query/crossing.h"
#include "narrowphase/witness.h"
#include "problem/minkowski.h"
#include "shape/body.h"

enum { VERDICT_NODES_BEFORE_NEWTON = 4 };

/* Easy verdicts are answered before Newton has paid for itself. */
static uint32_t nodes_before_newton(const query *q) {
  return query_wants_verdict(q) ? VERDICT_NODES_BEFORE_NEWTON : 0;
}

/* An upper bound that needs no improvement. */
static double good_enough(const query *q) {
  if (q->is_signed) return -INFINITY;
  return query_wants_verdict(q) ? q->limit : q->options.epsilon;
}

/* The direction from a surface point to the moving object's centre. The normal is that of the best lower bound: a
 * search that stops early, because its upper bound is good enough, leaves another direction between the two points that
 * attain that upper bound. */
static vec3 witness_direction(vec3 centre, vec3 surface, vec3 normal) {
  const vec3 between = vec_sub(centre, surface);
  const double length = vec_norm(between), sizes = vec_norm(centre) + vec_norm(surface);
  const bool aligned = vec_norm2(normal) == 0.0 || length - vec_dot(between, normal) <= 64.0 * ROUND_U * sizes;
  return aligned ? normal : vec_scale(1.0 / length, between);
}

/* The two surface points and their normal: where the ball of the mover and the padded target come closest, or one point
 * of both where they overlap; signed, the two ends of the way out. */
static void report_points(const query *q, const placed_pair *p, vec3 centre, vec3 surface, vec3 normal, double apart,
                          cprox_result *r) {
  const double margin = p->margin;
  if (apart > 0.0) normal = witness_direction(centre, surface, normal);
  r->normal = normal;
  r->obstacle_index = p->which.target, r->obstacle_part = p->which.part;
  if (q->is_signed || apart > margin + q->mover.radius) {
    r->witness_obstacle = vec_axpy(surface, margin, normal);
    r->witness_mover = vec_axpy(centre, -q->mover.radius, normal);
  } else {
    /* the padded target's nearest point to the ball's centre */
    r->witness_mover = r->witness_obstacle = apart > margin ? vec_axpy(surface, margin, normal) : centre;
  }
}

/* The same where a body is carried, its curve at `centre`, or what stands is on the clock: asked of the pair that both
 * make there. */
static cprox_status report_pair(const query *q, const placed_pair *p, vec3 centre, const cprox_obstacle *standing,
                                int32_t part, vec3 normal, cprox_result *r) {
  const cprox_obstacle moved = {.body = q->mover.body ? q->mover.body : &carried_point,
                                .pose = {.position = centre, .orientation = {1, 0, 0, 0}},
                                .margin = q->mover.radius};
  pair_witness witness;
  const cprox_status status = pair_witness_of(&moved, (size_t)p->which.mover_part, standing, (size_t)part, p->lod,
                                              q->is_signed, q->workspace, &witness);
  if (status < 0) return status;
  const bool normal_known = vec_norm2(normal) > 0.0;
  r->normal = normal_known ? normal : witness.normal;
  r->obstacle_index = p->which.target, r->obstacle_part = p->which.part, r->mover_part = p->which.mover_part;
  r->witness_mover = witness.on_a, r->witness_obstacle = witness.on_b;
  return CPROX_OK;
}

/* A carried body and what stands make one shape. */
static bool begin_carried(const query *q, const placed_pair *p, const cprox_curve *curve, curve_convex *o) {
  carried_shape joined = {.placed = p->frame};
  if (!carried_join(p->shape, &p->pose, p->carried, &p->carried_pose, &joined)) return false;
  joined.shape.slack += p->position_error;
  const double offset = p->offset + joined.offset;
  if (!curve_convex_begin(o, curve, &p->shape->shape, joined.placed, offset, q->workspace)) return false;
  o->joined = joined.shape;
  o->shape = &o->joined;
  return true;
}

/* The curve that the search runs along, about the obstacle: synchronized it is where the mover is, seen from the other.
 * NULL where memory is out. */
static const cprox_curve *curve_about(const query *q, const placed_pair *p, cprox_curve *relative) {
  const cprox_obstacle *obstacle = p->obstacle;
  if (!obstacle->synchronized) return q->mover.curve;
  const bool made =
      relative_create(q->mover.curve, obstacle->curve, &obstacle->pose, q->t0, q->t1, q->workspace, relative);
  return made ? relative : NULL;
}

/* The search owns the relative curve, which is all of it; of another curve it sees the part in query. */
static void keep_curve(const query *q, const placed_pair *p, const cprox_curve *relative, cprox_curve *kept,
                       curve_side *side) {
  side->part = q->part;
  if (!p->obstacle->synchronized) return;
  *kept = *relative;
  side->curve = kept;
  side->part = curve_side_whole();
}

bool placed_begin_convex(const query *q, const placed_pair *p, curve_convex *o) {
  cprox_curve relative;
  const cprox_curve *curve = curve_about(q, p, &relative);
  if (!curve) return false;
  if (q->mover.body) {
    if (!begin_carried(q, p, curve, o)) return false;
  } else if (!curve_convex_begin(o, curve, &p->shape->shape, p->frame, p->offset, q->workspace)) {
    return false;
  }
  keep_curve(q, p, &relative, &o->relative, &o->side);
  return true;
}

/* That of the best sample in the world; none where it is only one to bound by. */
static vec3 normal_seen(const curve_convex *o) {
  if (vec_norm2(o->best.near.normal) == 0.0) return vec(0, 0, 0);
  return frame_turn_to_world(&o->side.frame, o->best.normal);
}

/* Where the other mover is at the parameter of the best sample, and this one from there. */
static cprox_status report_clock(const query *q, const placed_pair *p, const curve_convex *o, vec3 apart,
                                 cprox_result *r) {
  cprox_obstacle standing = *p->obstacle;
  const vec3 at = relative_point(standing.curve, r->t, o->best.s == 1.0, q->workspace);
  const frame f = frame_create(&standing.pose, vec(0, 0, 0));
  standing.pose.position = frame_to_world(&f, at);
  if (!standing.body) standing.body = &carried_point;
  r->t_obstacle = r->t;
  const vec3 centre = vec_add(standing.pose.position, apart);
  return report_pair(q, p, centre, &standing, p->which.part, normal_seen(o), r);
}

cprox_status placed_report_convex(const query *q, const placed_pair *p, const curve_convex *o, cprox_result *r) {
  if (o->incumbent == 0) return CPROX_OK;
  const frame *f = &o->side.frame;
  const curve_sample *best = &o->best;
  r->t = curve_side_parameter(&o->side, best->piece, best->s);
  const cprox_obstacle *target = p->obstacle;
  if (target->synchronized) return report_clock(q, p, o, frame_to_world(f, best->y), r);
  if (q->mover.body) return report_pair(q, p, frame_to_world(f, best->y), target, p->which.part, normal_seen(o), r);
  report_points(q, p, frame_to_world(f, best->y), frame_to_world(f, best->near.point), normal_seen(o),
                best->near.distance, r);
  return CPROX_OK;
}

bool placed_is_tree(const placed_pair *p) {
  return p->shape && p->shape->tree;
}

bool placed_begin_tree(const query *q, const placed_pair *p, curve_tree *o) {
  cprox_curve relative;
  const cprox_curve *curve = curve_about(q, p, &relative);
  if (!curve || !curve_tree_begin(o, curve, p->shape, p->frame, p->offset, q->workspace)) return false;
  keep_curve(q, p, &relative, &o->relative, &o->side);
  return true;
}

void placed_report_tree(const query *q, const placed_pair *p, const curve_tree *o, cprox_result *r) {
  if (!o->found) return;
  const frame *f = &o->side.frame;
  const tree_sample *best = &o->best;
  const double margin = o->body->shape.margin;
  const cprox_obstacle *target = p->obstacle;
  r->t = curve_side_parameter(&o->side, best->piece, best->s);
  vec3 shift = vec(0, 0, 0);
  if (target->synchronized) {
    const frame other = frame_create(&target->pose, vec(0, 0, 0));
    shift = frame_to_world(&other, relative_point(target->curve, r->t, best->s == 1.0, q->workspace));
    r->t_obstacle = r->t;
  }
  const vec3 centre = frame_to_world(f, best->y);
  const vec3 surface = frame_to_world(f, vec_axpy(best->near.point, margin, best->near.normal));
  report_points(q, p, vec_add(centre, shift), vec_add(surface, shift), frame_turn_to_world(f, best->near.normal),
                best->near.distance - margin, r);
}

bool placed_begin_curve(const query *q, const placed_pair *p, curve_curve *o) {
  const cprox_obstacle *other = p->obstacle;
  if (!curve_curve_begin(o, q->mover.curve, other->curve, &other->pose, p->offset, q->workspace)) return false;
  o->side[0].part = q->part;
  return !p->carried || curve_curve_carry(o, &other->pose, p->carried, &p->carried_pose);
}

cprox_status placed_report_curve(const query *q, const placed_pair *p, const curve_curve *o, cprox_result *r) {
  if (o->incumbent == 0) return CPROX_OK;
  const frame *f = &o->side[0].frame;
  const curve_meeting *best = &o->best;
  r->t = curve_side_parameter(&o->side[0], best->piece[0], best->s[0]);
  r->t_obstacle = curve_side_parameter(&o->side[1], best->piece[1], best->s[1]);
  if (q->mover.body) {
    const vec3 at = frame_to_world(f, best->point[1]);
    const cprox_obstacle standing = {
        .body = &carried_point, .pose = {.position = at, .orientation = {1, 0, 0, 0}}, .margin = p->obstacle->margin};
    return report_pair(q, p, frame_to_world(f, best->point[0]), &standing, 0, frame_turn_to_world(f, best->normal), r);
  }
  report_points(q, p, frame_to_world(f, best->point[0]), frame_to_world(f, best->point[1]),
                frame_turn_to_world(f, best->normal), best->distance, r);
  return CPROX_OK;
}

/* So near that only a proof of contact is better: the sides of a flat body may have one. */
static bool proves_crossing(const query *q, curve_convex *o) {
  curve_sample sample = o->best;
  const double upper = o->best_bound.upper;
  if (q->limit != 0.0 || !(upper > 0.0 && upper <= q->options.epsilon) || !crossing_prove_convex(o, &sample))
    return false;
  curve_convex_adopt(o, &sample, (search_best){.upper = 0.0, .slack = o->best_bound.slack});
  return true;
}

static cprox_status search_convex(const query *q, const placed_pair *p, const search_goal *goal, search_outcome *found,
                                  cprox_result *r) {
  curve_convex o;
  if (!placed_begin_convex(q, p, &o)) return CPROX_MEMORY;
  o.newton_after = nodes_before_newton(q);
  o.good_enough = good_enough(q);
  o.epsilon = q->options.epsilon;
  o.is_signed = q->is_signed;
  const search_oracle oracle = curve_convex_oracle(&o);
  search_node root = curve_convex_root(&o);
  search_goal rest = *goal;
  if (p->which.seed_s > 0.0) {
    const cprox_status seeded = curve_convex_seed(&o, p->which.seed_piece, p->which.seed_s, &root);
    if (seeded < 0) return seeded;
    rest.cutoff = lesser(rest.cutoff, o.best_bound.upper);
  }
  cprox_status status = CPROX_OK;
  if (query_wants_verdict(q) && o.best_bound.upper <= q->limit)
    found->lower = root.lower;
  else
    status = search_run(&rest, &oracle, root, q->workspace, found);
  r->distance_queries = o.distance_queries;
  const bool crosses = status >= 0 && proves_crossing(q, &o);
  found->best = o.best_bound;
  const cprox_status reported = status >= 0 ? placed_report_convex(q, p, &o, r) : status;
  if (crosses) r->witness_obstacle = r->witness_mover;
  return reported < 0 ? reported : status;
}

static cprox_status search_curve(const query *q, const placed_pair *p, const search_goal *goal, search_outcome *found,
                                 cprox_result *r) {
  curve_curve o;
  if (!placed_begin_curve(q, p, &o)) return CPROX_MEMORY;
  o.newton_after = nodes_before_newton(q);
  o.good_enough = good_enough(q);
  o.epsilon = q->options.epsilon;
  o.is_signed = q->is_signed;
  const search_oracle oracle = curve_curve_oracle(&o);
  const cprox_status status = search_run(goal, &oracle, curve_curve_root(&o), q->workspace, found);
  r->distance_queries = o.distance_queries;
  const cprox_status reported = status >= 0 ? placed_report_curve(q, p, &o, r) : status;
  return reported < 0 ? reported : status;
}

static cprox_status search_tree(const query *q, const placed_pair *p, const search_goal *goal, search_outcome *found,
                                cprox_result *r) {
  curve_tree o;
  search_node root;
  if (!placed_begin_tree(q, p, &o) || !curve_tree_root(&o, &root)) return CPROX_MEMORY;
  o.asked = *goal;
  o.asked.order = SEARCH_DEPTH_FIRST; /* lists of elements are kept on a stack */
  o.newton_after = nodes_before_newton(q);
  o.good_enough = good_enough(q);
  const search_oracle oracle = curve_tree_oracle(&o);
  const cprox_status status = search_run(&o.asked, &oracle, root, q->workspace, found);
  r->distance_queries = o.distance_queries;
  if (status >= 0) placed_report_tree(q, p, &o, r);
  return status;
}

/* The one place that says which kernel answers. */
static cprox_status search_any(const query *q, const placed_pair *p, const search_goal *goal, search_outcome *found,
                               cprox_result *r) {
  if (placed_is_tree(p)) return search_tree(q, p, goal, found, r);
  return p->shape ? search_convex(q, p, goal, found, r) : search_curve(q, p, goal, found, r);
}

/* By the one model that the candidate names. */
static cprox_status search_model(const query *q, const candidate *c, double cutoff, cprox_result *result) {
  const placed_pair placed = placed_pair_resolve(q, c), *p = &placed;
  cprox_result r = {.obstacle_index = -1, .t_obstacle = NAN, .lod = p->lod};
  search_goal goal = query_goal(q, query_order(q), cutoff);
  const bool depth_unknown = q->is_signed && placed_is_tree(p);
  if (depth_unknown) goal.is_signed = false;
  search_outcome found = {0};
  r.status = search_any(q, p, &goal, &found, &r);
  if (r.status == CPROX_MEMORY) return workspace_fail(q->workspace, r.status, "no memory for the open intervals");
  if (r.status < 0) return r.status;

  /* distances are not negative, unless asked for; where the search fell short the ball may know a better lower bound */
  const double least = q->is_signed ? -INFINITY : 0.0;
  double by_ball = c->lower;
  if (isinf(by_ball) && (r.status != CPROX_OK || depth_unknown)) by_ball = candidate_ball_bound(q, c);
  r.nodes = found.nodes;
  r.upper = greater(found.best.upper, least);
  r.lower = lesser(greater(greater(found.lower, by_ball), least), r.upper);
  if (depth_unknown &&
      !(found.lower > 0.0)) { /* how deep cells and clouds go is not known: only the ball round all bounds it */
    r.lower = fmin(by_ball, r.upper);
    if (r.upper <= 2.0 * found.best.slack) r.status = CPROX_OVERLAP; /* 0 but for rounding */
  }
  *result = r;
  return r.status;
}

/* ---- level-of-detail bodies ---- */

bool candidate_may_refine(const query *q, const candidate *c) {
  const cprox_body *body = q->targets[c->target].body;
  if (!body || c->lod != CPROX_LOD_NONE || q->options.max_lod != CPROX_LOD_MESH) return false;
  if (body->kind == CPROX_BODY_COMPOUND) body = body->parts[c->part].body;
  return body->kind == CPROX_BODY_LOD;
}

cprox_status candidate_measure_mesh(const query *q, const candidate *c, cprox_result *result) {
  const placed_pair p = placed_pair_resolve(q, c);
  curve_tree o;
  if (!placed_begin_tree(q, &p, &o)) return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for a curve");
  curve_tree_measure_at(&o, result->t);
  if (curve_side_status(&o.side) < 0) return curve_side_status(&o.side);
  result->distance_queries += o.distance_queries;
  result->upper = fmax(o.best_bound.upper, 0.0);
  placed_report_tree(q, &p, &o, result);
  return CPROX_OK;
}

/* Whether the hull alone settles the query: it stays beyond the limit, or beyond what would be of interest. */
static cprox_status search_hull(const query *q, const candidate *c, double cutoff, cprox_result *r, bool *settled) {
  query of_hull = *q;
  of_hull.is_signed = false;
  if (!query_wants_verdict(q))
    of_hull.limit = cutoff - fmax(q->options.epsilon, q->options.relative_epsilon * fabs(cutoff));
  *settled = false;
  *r = (cprox_result){.upper = INFINITY};
  if (!(of_hull.limit >= 0.0 && of_hull.limit < INFINITY)) return CPROX_OK;
  candidate hull = *c;
  hull.lod = CPROX_LOD_HULL;
  const cprox_status status = search_model(&of_hull, &hull, INFINITY, r);
  if (status < 0) return status;
  *settled = r->lower > of_hull.limit;
  r->status = CPROX_OK;
  if (!*settled || !query_wants_verdict(q) || r->obstacle_index < 0) {
    /* what the hull attains the mesh need not attain */
    r->upper = INFINITY, r->obstacle_index = -1;
    return CPROX_OK;
  }
  return candidate_measure_mesh(q, c, r);
}

cprox_status candidate_rank(const query *q, candidate *c, uint32_t *nodes, uint32_t *distance_queries) {
  static const double CLOSE_ENOUGH = 0.01;
  query of_hull = *q;
  of_hull.is_signed = false;
  of_hull.options.relative_epsilon = fmax(q->options.relative_epsilon, CLOSE_ENOUGH);
  c->lod = CPROX_LOD_HULL;
  cprox_result r = {0};
  const cprox_status status = search_model(&of_hull, c, INFINITY, &r);
  if (status < 0) return status;
  c->lod = CPROX_LOD_MESH;
  if (r.lower > 0.0) c->lower = fmax(c->lower, r.lower);
  *nodes += r.nodes, *distance_queries += r.distance_queries;
  return CPROX_OK;
}

cprox_status candidate_search(const query *q, const candidate *c, double cutoff, cprox_result *result) {
  if (!candidate_may_refine(q, c)) return search_model(q, c, cutoff, result);
  bool settled;
  cprox_result by_hull = {0};
  const cprox_status looked = search_hull(q, c, cutoff, &by_hull, &settled);
  if (looked < 0) return looked;
  if (settled) {
    *result = by_hull;
    return CPROX_OK;
  }
  const cprox_status status = search_model(q, c, cutoff, result);
  if (status < 0) return status;
  if (by_hull.lower > 0.0) result->lower = fmin(fmax(result->lower, by_hull.lower), result->upper);
  result->nodes += by_hull.nodes, result->distance_queries += by_hull.distance_queries;
  return status;
}
