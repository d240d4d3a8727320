/* SPDX-License-Identifier: BSD-3-Clause */
/* Danskin along a motion: where the minimiser is one alone, the derivatives of the least distance are those of the
 * distance there. doc/robot-depth.md, Gradients.
 *
 * The search for the distance goes on where it would end: to the nodes that come within `apart` of the least distance.
 * What is left of them in the end is near the minimiser, and of its pair. */
#include "solve/motion_gradient.h"

#include <math.h>
#include <string.h>

#include "base/workspace.h"
#include "robot_query/answer.h"
#include "robot_query/measure.h"
#include "robot_query/robot_depth.h"
#include "solve/motion_derivatives.h"

/* How near another minimiser must not come, in sizes of the robot, and at least in roundings of distances. */
static const double APART = 1e-9, APART_ROUNDINGS = 16.0;

/* The neighbourhoods of the minimiser that are tried, as fractions of the motion, until their ends are farther away by
 * that and more. */
static const double NEIGHBOURHOOD[] = {1e-4, 1e-3, 1e-2, 3e-2};
static const double FARTHER = 4.0;

/* Where in a neighbourhood, from the minimiser on, the distance must fall towards it. */
static const double INSIDE = 0.25;

/* A node that reaches out of a neighbourhood is part of it where it is shorter than this fraction of it. */
static const double REACHING_OUT = 0.25;

/* A node that is shorter and could still be as near, is. */
static const double SHORTEST = 0x1p-22;

/* Of nodes after the distance is known; and after how many a wider neighbourhood is tried. */
enum { MOST_NODES = 400, PATIENCE = 16, NEIGHBOURHOODS = sizeof NEIGHBOURHOOD / sizeof *NEIGHBOURHOOD };

typedef struct gradient_search {
  robot_search o;
  search_oracle robot; /* that of the distance alone */
  motion_interval within;
  const query *q;
  cprox_status failure; /* where that is negative the search ends */

  bool settled;    /* the minimiser is known, */
  const char *why; /* or why there is none alone; NULL: nothing is known against it */
  double lower;    /* the least bound of nodes that were set aside */
  spot_pair pair;
  motion_spot spot;
  motion_spot side[SPOT_SIDES]; /* where two ways out cross there: the derivative is a sum of those at these places */
  double part[SPOT_SIDES];
  bool crosses;
  double apart;
  double from, to; /* the neighbourhood of the minimiser, in time; */
  size_t widest;   /* the widest that was tried */
  double previous; /* the least of local minima that were taken for the minimiser and are not */
  uint32_t nodes;  /* since the minimiser is known */
} gradient_search;

/* ---- the minimiser ---- */

/* Does the motion change how the two of the nearest pair stand to each other? */
static bool is_moved(const robot_search *o) {
  const robot_pair *pair = &o->scene.pairs[o->best.pair];
  const cprox_motion *m = o->scene.motion;
  const robot_part *parts = m->robot->parts;
  const int32_t other = pair->self ? parts[pair->standing].link : -1;
  return !m->is_state && cprox_motion_get_link_info(m, parts[pair->moving].link, other).n_moved > 0;
}

static bool is_in(const motion_given *given, int32_t variable) {
  for (size_t k = 0; k < given->n; k++)
    if (given->variables[k] == variable) return true;
  return false;
}

/* Could other values of what the motion is made of move the two against each other? */
static bool is_given(const gradient_search *g) {
  const cprox_motion *m = g->o.scene.motion;
  const cprox_robot *robot = m->robot;
  const robot_pair *pair = &g->pair.pair;
  const int32_t ends[2] = {robot->parts[pair->moving].axis, pair->self ? robot->parts[pair->standing].axis : -1};
  for (int k = 0; k < 2; k++)
    for (int32_t axis = ends[k]; axis != pair->common; axis = robot->axes[axis].parent) {
      const int32_t variable = robot->axes[axis].variable;
      if (is_in(&m->given, variable)) return true;
      for (size_t i = 0; i < m->n_joined; i++)
        if (is_in(&m->joined[i], variable)) return true;
    }
  return false;
}

/* The spot at a time of the motion. */
static cprox_status measure_at(gradient_search *g, double t, bool from_left, motion_spot *spot) {
  const cprox_motion *m = g->o.scene.motion;
  size_t segment = motion_segment_at(m, t);
  if (from_left && segment > 0 && m->times[segment] >= t) segment--;
  const double u = (t - m->times[segment]) / (m->times[segment + 1] - m->times[segment]);
  return spot_measure(&g->pair, segment, fmin(fmax(u, 0.0), 1.0), spot);
}

/* On one side of the minimiser, towards `t`: farther there, and falling towards the minimiser between. */
static cprox_status rises_towards(gradient_search *g, double here, double t, bool *rises) {
  const double sign = t < here ? -1.0 : 1.0, place[2] = {t, here + INSIDE * (t - here)};
  *rises = true;
  for (int k = 0; k < 2 && *rises; k++) {
    motion_spot there;
    const cprox_status status = measure_at(g, place[k], sign > 0.0, &there);
    if (status < 0) return status;
    *rises = k == 0 ? there.gap.lower >= g->spot.gap.upper + FARTHER * g->apart : sign * there.slope > 0.0;
  }
  return CPROX_OK;
}

/* The least neighbourhood of the minimiser, from the first-th on, whose ends are farther away. */
static cprox_status find_neighbourhood(gradient_search *g, size_t first) {
  const cprox_motion *m = g->o.scene.motion;
  const double t0 = motion_time(m, g->within.first, g->within.a), t1 = motion_time(m, g->within.last - 1, g->within.b);
  const double here = spot_time(&g->pair, &g->spot);
  double *const side[2] = {&g->from, &g->to};
  for (int k = 0; k < 2; k++) {
    bool rises = false;
    for (size_t i = first; i < NEIGHBOURHOODS && !rises; i++) {
      g->widest = i > g->widest ? i : g->widest;
      const double width = NEIGHBOURHOOD[i] * (t1 - t0), end = k == 0 ? fmax(here - width, t0) : fmin(here + width, t1);
      *side[k] = end;
      if (end == here) break;
      const cprox_status status = rises_towards(g, here, end, &rises);
      if (status < 0) return status;
      if (!rises && (end == t0 || end == t1)) break;
    }
    if (!rises && *side[k] != here) g->why = "the distance is as small on an interval of the motion";
  }
  return CPROX_OK;
}

static bool is_zero(const gradient_search *g, double distance, double rounding) {
  return !((g->q->is_signed ? fabs(distance) : distance) > rounding);
}

/* The distance is known: where exactly is it least, and is it least there alone? */
static cprox_status settle(gradient_search *g) {
  robot_search *o = &g->o;
  g->settled = true;
  o->goal.epsilon = fmin(o->goal.epsilon, g->apart); /* distances are to be known that well from here on */
  if (o->best.pair < 0) {
    g->why = "nothing was measured";
    return CPROX_OK;
  }
  if (is_zero(g, o->best_bound.upper, APART_ROUNDINGS * o->best_bound.slack)) {
    g->why = "the distance is 0";
    return CPROX_OK;
  }
  const bool moved = is_moved(o);
  if (!spot_begin(&o->scene, o->best.pair, &g->pair)) return robot_no_memory(o);
  cprox_status status = spot_measure(&g->pair, o->best.segment, o->best.u, &g->spot);
  if (status < 0) return status;
  bool good = true;
  if (moved) status = spot_refine(&g->pair, &g->within, &g->spot, &good);
  if (status < 0) return status;
  if (!good) {
    g->why = "the distance is as small on an interval of the motion";
    return CPROX_OK;
  }
  const robot_gap *gap = &g->spot.gap;
  if (gap->upper < o->best_bound.upper) {
    o->best = (robot_sample){.gap = *gap, .pair = o->best.pair, .segment = g->spot.segment, .u = g->spot.u};
    o->best_bound = (search_best){.upper = g->q->is_signed ? gap->upper : fmax(gap->upper, 0.0), .slack = gap->slack};
  }
  const bool known = gap->lower > 0.0 || (g->q->is_signed && gap->upper < 0.0);
  if (vec_norm2(gap->normal) == 0.0 || !known) {
    g->why = "the distance is 0";
    return CPROX_OK;
  }
  if (APART_ROUNDINGS * gap->slack > g->apart) {
    g->why = "rounding is larger than the distance to other minimisers";
    return CPROX_OK;
  }
  status = spot_is_alone(&g->pair, &g->spot, g->apart, &good);
  g->crosses = false;
  if (status >= 0 && !good && gap->upper < 0.0 && moved) {
    status = spot_find_crossing(&g->pair, &g->within, &g->spot, g->apart, g->side, g->part, &good);
    g->crosses = good;
  }
  if (status < 0) return status;
  if (!good) g->why = gap->upper < 0.0 ? "there is more than one way out" : "the nearest points are not the only ones";
  if (good && !moved && !g->o.scene.motion->is_state && is_given(g))
    g->why = "the distance is as small on an interval of the motion";
  g->from = -INFINITY, g->to = INFINITY, g->widest = 0, g->nodes = 0;
  return moved && !g->why ? find_neighbourhood(g, 0) : CPROX_OK;
}

/* ---- the search ---- */

static double filter(void *self, search_node *node, double goal) {
  gradient_search *g = self;
  const double lower = g->robot.filter(&g->o, node, goal);
  if (g->failure < 0) return INFINITY;
  const double known = g->o.best_bound.upper;
  const double width = width_allowed(g->q->options.epsilon, g->q->options.relative_epsilon, known);
  if (!g->settled && lower >= known - width) g->failure = settle(g);
  if (!g->why && g->failure >= 0) return lower;
  g->lower = fmin(g->lower, lower);
  return INFINITY;
}

/* Whether the node is in the neighbourhood of the minimiser, or is short and reaches into it. */
static bool is_near(const gradient_search *g, const search_node *node) {
  const cprox_motion *m = g->o.scene.motion;
  const motion_interval over = robot_interval(node);
  const double a = motion_time(m, over.first, over.a), b = motion_time(m, over.last - 1, over.b);
  if (a >= g->from && b <= g->to) return true;
  return a <= g->to && b >= g->from && b - a <= REACHING_OUT * (g->to - g->from);
}

/* Whether the node is there, and all that is left in it are the two parts that are nearest there. */
static bool is_of_minimiser(const gradient_search *g, const search_node *node) {
  if (!is_near(g, node)) return false;
  const int32_t list = robot_known(node)->list;
  const size_t n = lists_count(&g->o.lists, list);
  for (size_t i = 0; i < n; i++) {
    const list_entry *entry = &lists_at(&g->o.lists, list)[i];
    if (entry->pair < 0) return false;
    const robot_pair *pair = &g->o.scene.pairs[entry->pair], *of = &g->pair.pair;
    if (pair->moving != of->moving || pair->standing != of->standing || pair->self != of->self) return false;
  }
  return true;
}

static bool is_shortest(const search_node *node) {
  const motion_interval over = robot_interval(node);
  return !motion_is_span(&over) && over.b - over.a <= SHORTEST;
}

/* A distance that is less than that of the minimiser: of another one. */
static void look_for_better(gradient_search *g) {
  if (!(g->o.best_bound.upper < g->spot.gap.lower)) return;
  g->previous = fmin(g->previous, g->spot.gap.lower);
  g->settled = false;
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  gradient_search *g = self;
  if (g->failure < 0) return g->failure;
  const cprox_status status = g->robot.probe(&g->o, node, best);
  if (status < 0 || !g->settled || g->why) return status;
  look_for_better(g);
  if (!g->settled || !(node->lower < INFINITY)) return status;
  if (!is_of_minimiser(g, node)) {
    g->nodes++;
    const bool short_of = is_shortest(node) || g->nodes > MOST_NODES;
    if (!short_of && g->nodes % PATIENCE > 0) return status;
    if (g->widest + 1 < NEIGHBOURHOODS && isfinite(g->from)) return find_neighbourhood(g, g->widest + 1);
    if (short_of) g->why = "the distance is as small elsewhere along the motion, or of another pair";
    return status;
  }
  g->lower = fmin(g->lower, node->lower);
  node->lower = INFINITY;
  return status;
}

static int split(void *self, search_node *node, search_node *child) {
  gradient_search *g = self;
  return g->robot.split(&g->o, node, child);
}

static void release(void *self, const search_node *node) {
  gradient_search *g = self;
  g->robot.release(&g->o, node);
}

static cprox_status run(gradient_search *g, search_outcome *found) {
  robot_search *o = &g->o;
  const query *q = g->q;
  search_goal goal = query_goal(q, SEARCH_BEST_FIRST, INFINITY);
  const cprox_robot *robot = q->mover.motion->robot;
  for (size_t i = 0; i < robot->n_parts; i++) g->apart = fmax(g->apart, APART * robot->parts[i].reach);
  goal.beyond = g->apart;
  robot_search_begin(o, &goal);
  g->robot = robot_search_oracle(o);
  *found = (search_outcome){.lower = INFINITY};
  if (o->scene.n_pairs == 0 && !q->set) {
    g->why = "there is nothing to be near";
    return CPROX_OK;
  }
  search_node root;
  if (!robot_search_root(o, &g->within, &g->within, &root)) return robot_no_memory(o);
  const search_oracle oracle = {
      .self = g, .work = g->robot.work, .filter = filter, .probe = probe, .split = split, .release = release};
  const cprox_status status = search_run(&o->goal, &oracle, root, q->workspace, found);
  if (g->failure < 0) return g->failure;
  if (status == CPROX_MEMORY) return workspace_fail(q->workspace, status, "no memory for the open intervals");
  return status;
}

/* ---- the answer ---- */

/* By the models that the query allows. */
static cprox_status gradient_of_models(const query *q, size_t first, size_t last, cprox_result *result,
                                       cprox_motion_gradient *gradient, const char **why) {
  gradient_search g = {.q = q, .lower = INFINITY, .previous = INFINITY};
  if (start_class_is_one_of_many(q->mover.motion))
    return workspace_fail(q->workspace, CPROX_INVALID, "there is no gradient where starts have tolerances");
  if (!robot_scene_begin(&g.o.scene, q, NULL, first, last, SIZE_MAX, INFINITY))
    return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for the pairs of a robot");
  g.within = motion_interval_of(q->mover.motion, q->t0, q->t1);
  search_outcome found;
  const cprox_status status = run(&g, &found);
  if (status < 0) return status;
  if (!g.why && (status == CPROX_BUDGET || status == CPROX_STOPPED)) g.why = query_shortfall(status);
  if (!g.settled && !g.why) {
    const cprox_status settled = settle(&g);
    if (settled < 0) return settled;
  }

  /* the least of all that left the search, whatever for */
  cprox_result r = {.t_obstacle = NAN, .obstacle_index = -1, .mover_part = -1, .upper = g.o.best_bound.upper};
  robot_search_report(&g.o, &r);
  r.lower = fmin(fmin(found.lower, g.o.dropped), g.lower);
  r.lower = fmin(q->is_signed ? r.lower : fmax(r.lower, 0.0), r.upper);
  r.nodes = found.nodes + g.o.flights, r.distance_queries += g.pair.gaps;
  query_conclude(q, INFINITY, status, &r);

  if (!g.why && !(g.previous > g.spot.gap.upper + g.apart))
    g.why = "the distance is as small elsewhere along the motion, or of another pair";
  if (g.settled && g.pair.scene) {
    const spots one = {&g.spot, NULL, 1}, crossing = {g.side, g.part, SPOT_SIDES};
    motion_derivatives_fill(&g.pair, &g.spot, g.crosses ? &crossing : &one, gradient);
  } else {
    motion_derivatives_fill_nothing(q->mover.motion, gradient);
  }
  gradient->valid = !g.why;
  *result = r;
  *why = g.why;
  return r.status;
}

cprox_status motion_gradient_check(const query *q, const cprox_motion_gradient *gradient) {
  const cprox_motion *motion = q->mover.motion;
  const bool rows = gradient->positions || gradient->velocities || gradient->accelerations;
  if (!rows || motion->kind == CPROX_MOTION_JOINED || !motion->arc_of) return CPROX_OK;
  return workspace_fail(q->workspace, CPROX_INVALID,
                        "slerp and screws have a gradient by their variables, not by their points");
}

cprox_status motion_gradient_of(const query *q, size_t first, size_t last, cprox_result *result,
                                cprox_motion_gradient *gradient) {
  const query apart = robot_depth_apart(q), hulls = robot_depth_hulls(q);
  const bool two = q->is_signed && robot_depth_has_meshes(q, first, last);
  const char *why = NULL;
  cprox_result r = {0};
  cprox_status status = CPROX_OK;
  for (int deep = q->is_signed && !two; deep < 2; deep++) {
    cprox_result one = {0};
    status = gradient_of_models(deep ? &hulls : &apart, first, last, &one, gradient, &why);
    if (status >= 0 && deep && two) status = robot_depth_join(q, INFINITY, &r, &one);
    if (status < 0) return status;
    r = one;
    if (!two || robot_depth_is_settled(q, &r)) break;
  }
  if (!gradient->valid) workspace_fail(q->workspace, status, "no gradient: %s", why);
  *result = r;
  return status;
}
