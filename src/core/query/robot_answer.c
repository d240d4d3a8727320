/* SPDX-License-Identifier: BSD-3-Clause */
#include "query/robot_answer.h"

#include <math.h>

#include "query/answer.h"
#include "query/robot_search.h"

/* ---- arguments ------------------------------------------------------------------------------------------------------------ */

static cprox_status check_pairs(const cprox_mover *mover, size_t n, cprox_workspace *workspace) {
  const size_t geometries = mover->motion->robot->n_geometries, others = mover->self ? geometries : n;
  for (size_t i = 0; mover->pairs && i < mover->n_pairs; i++) {
    const cprox_robot_pair *pair = &mover->pairs[i];
    if (pair->geometry < 0 || (size_t)pair->geometry >= geometries)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu: there is no geometry %d, the robot has %zu", i,
                            (int)pair->geometry, geometries);
    if (pair->other < 0 || (size_t)pair->other >= others)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu: there is no %s %d", i,
                            mover->self ? "geometry" : "target", (int)pair->other);
    if (mover->self && pair->geometry == pair->other)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu: geometry %d against itself", i, (int)pair->geometry);
  }
  return CPROX_OK;
}

cprox_status robot_check(const cprox_mover *mover, const cprox_target *targets, size_t n, cprox_workspace *workspace) {
  if (mover->curve || mover->body || mover->radius != 0.0)
    return workspace_fail(workspace, CPROX_INVALID,
                          "a mover is a robot's motion, or a curve and what rides it: not both; pad the robot's links");
  if (mover->self && n > 0)
    return workspace_fail(workspace, CPROX_INVALID, "a robot against itself has no targets, got %zu", n);
  for (size_t i = 0; i < n; i++) {
    const cprox_body *body = targets[i].body;
    if (!body || targets[i].curve)
      return workspace_fail(workspace, CPROX_INVALID, "target %zu is a curve: a robot is asked about bodies", i);
    if (part_model_is_solid(body))
      return workspace_fail(workspace, CPROX_INVALID,
                            "target %zu is a solid mesh: a robot is asked about surfaces; fill it with convex parts",
                            i);
  }
  return check_pairs(mover, n, workspace);
}

void robot_ask_whole(question *q) {
  cprox_motion_domain(q->mover.motion, &q->t0, &q->t1);
}

/* ---- the search ----------------------------------------------------------------------------------------------------------- */

/* Fractions are rounded outwards by a little more than a division can be off. */
static search_node root_of(const question *q, robot_search *o) {
  const cprox_motion *m = q->mover.motion;
  size_t first = 0, last = m->n_segments;
  while (first + 1 < last && m->times[first + 1] <= q->t0) first++;
  while (last > first + 1 && m->times[last - 1] >= q->t1) last--;
  const double u0 = (q->t0 - m->times[first]) / (m->times[first + 1] - m->times[first]);
  const double u1 = (q->t1 - m->times[last - 1]) / (m->times[last] - m->times[last - 1]);
  return robot_search_root(o, first, q->t0 <= m->times[first] ? 0.0 : fmax(u0 - 0x1p-50, 0.0), last,
                           q->t1 >= m->times[last] ? 1.0 : fmin(u1 + 0x1p-50, 1.0));
}

static cprox_status run(const question *q, const search_goal *goal, robot_search *o, search_outcome *found) {
  robot_search_begin(o, goal);
  *found = (search_outcome){.lower = INFINITY, .free_until = INFINITY, .best = {.upper = INFINITY, .at = INFINITY}};
  if (o->scene.n_pairs == 0 && !q->set) return CPROX_OK;
  const search_node root = root_of(q, o);
  if (root.side[0].slot < 0) return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for the lists of pairs");
  const search_oracle oracle = robot_search_oracle(o);
  const cprox_status status = search_run(goal, &oracle, root, q->workspace, found);
  if (status == CPROX_MEMORY) return workspace_fail(q->workspace, status, "no memory for the open intervals");
  return status;
}

static search_goal goal_of(const question *q, search_order order, double ceiling) {
  return (search_goal){.order = order,
                       .limit = q->limit,
                       .ceiling = ceiling,
                       .horizon = INFINITY,
                       .epsilon = q->options.epsilon,
                       .relative_epsilon = q->options.relative_epsilon,
                       .max_nodes = q->options.max_nodes,
                       .stop = q->options.stop,
                       .stop_user = q->options.stop_user};
}

/* ---- what was found ------------------------------------------------------------------------------------------------------- */

static void report(const robot_search *o, const robot_sight *sight, cprox_result *r) {
  if (sight->pair < 0) return;
  const robot_scene *s = &o->scene;
  const robot_pair *pair = &s->pairs[sight->pair];
  r->t = motion_time(s->motion, sight->segment, sight->u);
  r->on_mover = sight->gap.on_moving, r->on_target = sight->gap.on_standing, r->normal = sight->gap.normal;
  r->mover_part = s->parts[pair->moving].body.index;
  r->target_index = s->self ? s->parts[pair->standing].body.index : s->obstacles[pair->standing].index;
  r->target_part = s->self ? 0 : s->obstacles[pair->standing].part;
}

static cprox_rung rung_of(const robot_search *o) {
  if (o->scene.n_pairs == 0) return CPROX_RUNG_NONE;
  if (o->climbed) return CPROX_RUNG_MESH;
  const bool by_balls = o->gaps + o->planes == 0 || o->scene.q->options.max_rung == CPROX_RUNG_SPHERE;
  return by_balls ? CPROX_RUNG_SPHERE : CPROX_RUNG_HULL;
}

static bool is_satisfied(const question *q, double ceiling, const cprox_result *r) {
  if (question_wants_verdict(q) && question_verdict(q, r) != CPROX_UNDECIDED) return true;
  const double upper = fmin(r->upper, ceiling);
  return !(upper - r->lower > fmax(q->options.epsilon, q->options.relative_epsilon * upper));
}

cprox_status robot_answer(const question *q, size_t first, size_t last, double ceiling, cprox_result *result) {
  robot_search o;
  if (!robot_scene_begin(&o.scene, q, first, last))
    return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for the pairs of a robot");
  const search_goal goal = goal_of(q, question_wants_verdict(q) ? SEARCH_DEPTH_FIRST : SEARCH_BEST_FIRST, ceiling);
  search_outcome found;
  const cprox_status status = run(q, &goal, &o, &found);
  if (status < 0) return status;

  cprox_result r = {.t_target = NAN, .target_index = -1, .mover_part = -1, .upper = o.best_bound.upper};
  report(&o, &o.best, &r);
  r.lower = fmin(fmax(fmin(found.lower, o.dropped), 0.0), r.upper);
  r.nodes = found.nodes, r.probes = o.gaps;
  r.rung = rung_of(&o);
  r.status = is_satisfied(q, ceiling, &r) ? CPROX_OK : status != CPROX_OK ? status : CPROX_PRECISION;
  r.verdict = question_verdict(q, &r);
  if (r.status != CPROX_OK) workspace_fail(q->workspace, r.status, "%s", question_shortfall(r.status));
  *result = r;
  return r.status;
}

/* ---- first contact -------------------------------------------------------------------------------------------------------- */

cprox_status robot_first_contact(const question *q, cprox_result *result) {
  robot_search o;
  if (!robot_scene_begin(&o.scene, q, 0, q->n))
    return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for the pairs of a robot");
  const search_goal goal = goal_of(q, SEARCH_LEFT_TO_RIGHT, INFINITY);
  search_outcome found;
  const cprox_status status = run(q, &goal, &o, &found);
  if (status < 0) return status;

  const bool touch = o.touch.pair >= 0, near = o.best_bound.upper <= q->options.epsilon;
  const robot_sight *sight = touch ? &o.touch : &o.best;
  cprox_result r = {.t_target = NAN, .target_index = -1, .mover_part = -1};
  report(&o, sight, &r);
  r.upper = sight->pair < 0 ? INFINITY : fmax(sight->gap.upper, 0.0);
  r.lower = touch ? 0.0 : fmin(fmax(fmin(found.lower, o.dropped), 0.0), r.upper);
  r.t_free = fmin(found.free_until, q->t1);
  r.verdict = touch ? CPROX_YES : isinf(found.free_until) ? CPROX_NO : CPROX_UNDECIDED;
  if (sight->pair < 0) r.t = NAN;
  r.nodes = found.nodes, r.probes = o.gaps;
  r.rung = rung_of(&o);
  r.status = status;
  if (status == CPROX_OK && near && found.free_until < o.best_bound.at) r.status = CPROX_PRECISION;
  if (r.status != CPROX_OK) workspace_fail(q->workspace, r.status, "%s", question_shortfall(r.status));
  *result = r;
  return r.status;
}
