/* SPDX-License-Identifier: BSD-3-Clause */
/* One search: the engine with the oracle that the candidate asks for, and what it found in the terms of the caller. */
#include "curve_query/search_candidate.h"
#include "curve_query/report.h"
#include "shape/body.h"

/* A search by one model, and what it found. */
typedef struct model_search {
  placed_pair placed;
  curve_search s;
  search_outcome found;
  bool depth_unknown;     /* a sign is wanted, and the kernel has none */
  cprox_status shortfall; /* the true name of CPROX_PRECISION */
} model_search;

/* *r gets where the two are nearest. */
static cprox_status search_placed(model_search *m, const query *q, const candidate *c, double cutoff, cprox_result *r) {
  m->placed = placed_pair_resolve(q, c);
  m->found = (search_outcome){0};
  r->lod = m->placed.lod;
  curve_search *s = &m->s;
  const search_goal goal = query_goal(q, query_order(q), cutoff);
  cprox_status status = curve_search_begin(s, q, &m->placed);
  m->depth_unknown = q->is_signed && !s->kernel->knows_depth;
  if (status < 0) return status;
  curve_start start;
  start.goal = goal;
  start.upper = INFINITY;
  if (m->depth_unknown) start.goal.is_signed = false;
  status = s->kernel->start_distance(s, &start);
  if (status < 0) return status;
  start.goal.cutoff = lesser(start.goal.cutoff, start.upper);
  if (query_wants_verdict(q) && start.upper <= q->limit)
    m->found.lower = start.root.lower;
  else
    status = search_run(&start.goal, &start.oracle, start.root, q->workspace, &m->found);
  if (status < 0) return status;
  const bool crosses = s->kernel->prove_crossing && s->kernel->prove_crossing(s);
  curve_finding seen;
  s->kernel->best_found(s, &seen);
  seen.is_contact = crosses;
  m->found.best = seen.bound;
  m->shortfall = curve_kernel_shortfall(&m->placed, seen.bound.slack);
  r->distance_queries = seen.distance_queries;
  const cprox_status reported = report_finding(q, s->pair, &seen, r);
  return reported < 0 ? reported : status;
}

/* By the one model that the candidate names. */
static cprox_status search_model(const query *q, const candidate *c, double cutoff, cprox_result *result) {
  cprox_result r = {.obstacle_index = -1, .t_obstacle = NAN};
  model_search m;
  r.status = search_placed(&m, q, c, cutoff, &r);
  if (r.status == CPROX_MEMORY) return workspace_fail(q->workspace, r.status, "no memory for the open intervals");
  if (r.status < 0) return r.status;
  const search_outcome *found = &m.found;
  /* distances are not negative, unless asked for; where the search fell short the ball may know a better lower bound */
  const double least = q->is_signed ? -INFINITY : 0.0;
  double by_ball = c->lower;
  if (isinf(by_ball) && (r.status != CPROX_OK || m.depth_unknown)) by_ball = candidate_ball_bound(q, c);
  r.nodes = found->nodes;
  r.upper = greater(found->best.upper, least);
  r.lower = lesser(greater(greater(found->lower, by_ball), least), r.upper);
  if (m.depth_unknown &&
      !(found->lower > 0.0)) { /* how deep cells and clouds go is not known: only the ball round all bounds it */
    r.lower = fmin(by_ball, r.upper);
    if (r.upper <= 2.0 * found->best.slack) r.status = CPROX_OVERLAP; /* 0 but for rounding */
  }
  if (r.status == CPROX_OK && !m.depth_unknown && !query_is_satisfied(q, cutoff, &r)) r.status = CPROX_PRECISION;
  if (r.status == CPROX_PRECISION) r.status = m.shortfall;
  *result = r;
  return r.status;
}

/* ---- level-of-detail bodies ---- */

bool candidate_may_refine(const query *q, const candidate *c) {
  const cprox_body *body = q->obstacles[c->obstacle].body;
  if (!body || c->lod != CPROX_LOD_NONE || q->options.max_lod != CPROX_LOD_MESH) return false;
  return body_part_at(body, (size_t)c->part)->kind == CPROX_BODY_LOD;
}

cprox_status candidate_measure_mesh(const query *q, const candidate *c, cprox_result *result) {
  const placed_pair p = placed_pair_resolve(q, c);
  curve_search s;
  const cprox_status begun = curve_search_begin(&s, q, &p);
  if (begun < 0) return workspace_fail(q->workspace, begun, "no memory for a curve");
  curve_tree *o = &s.state.tree.base;
  curve_tree_measure_at(o, result->t);
  if (curve_side_status(&o->side) < 0) return curve_side_status(&o->side);
  result->distance_queries += o->distance_queries;
  result->upper = fmax(o->best_bound.upper, 0.0);
  curve_finding seen;
  s.kernel->best_found(&s, &seen);
  return report_finding(q, &p, &seen, result);
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

/* The mesh is no deeper than its hull. */
static cprox_status bound_depth(const query *q, const candidate *c, double cutoff, cprox_result *result) {
  candidate hull = *c;
  hull.lod = CPROX_LOD_HULL;
  cprox_result r = {0};
  const cprox_status status = search_model(q, &hull, lesser(cutoff, result->upper), &r);
  if (status < 0) return status;
  result->lower = greater(result->lower, lesser(r.lower, result->upper));
  result->nodes += r.nodes, result->distance_queries += r.distance_queries;
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
  if (q->is_signed && result->lower < 0.0) {
    const cprox_status bounded = bound_depth(q, c, cutoff, result);
    if (bounded < 0) return bounded;
  }
  return status;
}
