/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of a planner: lanes first, and the search for what they leave open. */
#include <math.h>
#include <string.h>

#include "base/workspace.h"
#include "edges/kernels.h"
#include "kinematics/motion.h"
#include "problem/obstacles.h"
#include "problem/problem.h"
#include "robot_query/answer.h"
#include "solve/list.h"

/* A call in the workspace's memory. */
typedef struct edges_call {
  const cprox_edge_checker *c;
  cprox_workspace *workspace;
  edge_kernel *kernel;
  edge_motion motion;
  edge_lanes lanes;
  cprox_robot_pair *pairs; /* room for all, and for all with itself behind them */
} edges_call;

enum { ALIGNED = 64, WHY = 256 };

static size_t aligned(size_t bytes) {
  return (bytes + ALIGNED - 1) / ALIGNED * ALIGNED;
}

static bool begin(edges_call *call) {
  const cprox_edge_checker *c = call->c;
  const size_t noted = c->n_near + c->n_lane_pairs;
  const size_t lanes = aligned(edge_lanes_size(c, c->n_near)), motion = aligned(edge_motion_size(c)),
               marks = aligned(2 * (noted + 1) * sizeof(uint32_t));
  const size_t pairs = (c->n_pairs + c->n_self_pairs + 1) * sizeof(cprox_robot_pair);
  char *memory = workspace_reserve(call->workspace, WORKSPACE_EDGES, ALIGNED + lanes + motion + marks + pairs);
  if (!memory) return false;
  memory += ALIGNED - (uintptr_t)memory % ALIGNED;
  call->lanes.memory = memory;
  call->motion = edge_motion_in(c, memory + lanes);
  call->lanes.open = (edge_open){.pairs = (uint32_t *)(void *)(memory + lanes + motion)};
  call->lanes.open.seen = call->lanes.open.pairs + noted + 1;
  call->pairs = (cprox_robot_pair *)(void *)(memory + lanes + motion + marks);
  memset(call->lanes.open.seen, 0, (noted + 1) * sizeof(uint32_t));
  call->kernel = edge_kernel_at(simd_of_machine());
  return true;
}

/* ---- what the search is asked ---- */

/* Pairs of geometries and obstacles, then of geometries; a part of the edge. */
typedef struct edge_rest {
  const cprox_robot_pair *pairs, *self_pairs;
  size_t n_pairs, n_self_pairs;
  double from, to;
  bool at_once; /* at the time `from` alone */
} edge_rest;

static edge_rest all_of(const cprox_edge_checker *c) {
  return (edge_rest){.pairs = c->pairs,
                     .self_pairs = c->pairs + c->n_pairs,
                     .n_pairs = c->n_pairs,
                     .n_self_pairs = c->n_self_pairs,
                     .to = 1.0};
}

static void add_pair(cprox_robot_pair *pairs, size_t *n, int32_t geometry, int32_t other) {
  for (size_t k = 0; k < *n; k++) /* parts of one obstacle are one pair */
    if (pairs[k].geometry == geometry && pairs[k].other == other) return;
  pairs[(*n)++] = (cprox_robot_pair){geometry, other};
}

static edge_rest open_of(const edges_call *call) {
  const cprox_edge_checker *c = call->c;
  const edge_open *open = &call->lanes.open;
  edge_rest rest = {.from = fmax(0.5 + (double)open->from, 0.0), .to = fmin(0.5 + (double)open->to, 1.0)};
  cprox_robot_pair *pairs = call->pairs, *self_pairs = call->pairs + c->n_pairs;
  for (uint32_t i = 0; i < open->n; i++) {
    const bool self = open->pairs[i] >= c->n_near;
    const edge_pair *two = self ? &c->lane_pairs[open->pairs[i] - c->n_near] : NULL;
    const edge_part *part = self ? &c->parts[two->a] : c->parts, *other = self ? &c->parts[two->b] : NULL;
    while (!self && open->pairs[i] >= part->first_near + part->n_near) part++;
    for (uint32_t k = part->first_member; k < part->first_member + part->n_members; k++) {
      if (!self) add_pair(pairs, &rest.n_pairs, c->members[k], c->obstacles[c->near[open->pairs[i]]].obstacle);
      for (uint32_t l = 0; self && l < other->n_members; l++)
        add_pair(self_pairs, &rest.n_self_pairs, c->members[k], c->members[other->first_member + l]);
    }
  }
  rest.pairs = pairs, rest.self_pairs = self_pairs;
  return rest;
}

static cprox_mover mover_of(const cprox_motion *motion, const edge_rest *rest) {
  if (rest->n_pairs == 0) return cprox_robot_self(motion, rest->self_pairs, rest->n_self_pairs);
  const cprox_mover along = cprox_robot_along(motion, rest->pairs, rest->n_pairs);
  return rest->n_self_pairs == 0 ? along : cprox_robot_whole(along, rest->self_pairs, rest->n_self_pairs);
}

static cprox_status create_motion(const edges_call *call, const double *from, const double *to, cprox_motion **motion) {
  const cprox_robot *robot = call->c->robot;
  const size_t n = robot->n_variables;
  if (memcmp(from, to, n * sizeof *from) == 0) {
    const cprox_motion_description state = {.kind = CPROX_MOTION_STATE, .rest = from};
    return WORKSPACE_LEND(call->workspace, cprox_motion_create(robot, &state, call->workspace, motion));
  }
  int32_t *variables = workspace_reserve(call->workspace, WORKSPACE_ORDER, (n + 1) * sizeof *variables);
  if (!variables) return workspace_fail(call->workspace, CPROX_MEMORY, "no memory for an edge");
  for (size_t i = 0; i < n; i++) variables[i] = (int32_t)i;
  const cprox_waypoint ends[2] = {{.time = 0.0, .positions = from}, {.time = 1.0, .positions = to}};
  const cprox_motion_description edge = {.kind = CPROX_MOTION_WAYPOINTS,
                                         .variables = variables,
                                         .n_variables = n,
                                         .waypoints = ends,
                                         .n_waypoints = 2,
                                         .interpolation = CPROX_INTERPOLATION_LINEAR};
  return WORKSPACE_LEND(call->workspace, cprox_motion_create(robot, &edge, call->workspace, motion));
}

/* What the search is asked about the rest: whether it stays beyond a distance, or its time of contact. */
typedef struct edge_question {
  double beyond;
  bool first;
} edge_question;

static cprox_status search(const edges_call *call, const cprox_motion *motion, const edge_rest *rest,
                           edge_question question, cprox_result *r) {
  const cprox_edge_query *asked = &call->c->asked;
  const bool about_obstacles = rest->n_pairs > 0;
  const cprox_obstacle *obstacles = about_obstacles ? obstacles_list(asked->obstacles) : NULL;
  const size_t n = about_obstacles ? obstacles_count(asked->obstacles) : 0;
  cprox_options options = asked->options ? *asked->options : CPROX_OPTIONS_DEFAULT;
  const double interval[2] = {rest->from, rest->to};
  options.interval = rest->to > rest->from && (rest->from > 0.0 || rest->to < 1.0) ? interval : NULL;
  const cprox_mover mover = mover_of(motion, rest);
  if (question.first) return list_time_of_contact(mover, obstacles, n, &options, call->workspace, r);
  query q = query_create(mover, obstacles, n, question.beyond, &options, call->workspace);
  const arguments_query has = {"edges", ARGUMENTS_SEARCH | ARGUMENTS_WHOLE | ARGUMENTS_INTERVAL};
  const cprox_status begun = query_begin(&q, has);
  if (rest->at_once) q.t0 = q.t1 = rest->from;
  return begun == CPROX_OK ? robot_answer(&q, 0, n, INFINITY, r) : begun;
}

/* ---- an edge ---- */

static void take_search(const edges_call *call, const edge_rest *rest, const cprox_result *r, cprox_edge_result *out) {
  out->verdict = r->verdict, out->status = r->status, out->level = CPROX_EDGE_SEARCH;
  out->nodes += r->nodes;
  out->t = NAN, out->geometry = out->other = -1;
  if (r->verdict != CPROX_VERDICT_VIOLATED) return;
  out->t = r->t;
  out->geometry = r->mover_part, out->other = r->obstacle_index;
  if (rest->n_pairs == 0) out->other += (int32_t)obstacles_count(call->c->asked.obstacles);
}

/* Whether it is clear beyond delta and the caller's rounding; what is not must be a hit without that rounding. */
static cprox_status search_both(const edges_call *call, const cprox_motion *motion, const edge_rest *rest,
                                cprox_edge_result *out) {
  const cprox_edge_checker *c = call->c;
  cprox_result r = {0};
  cprox_status status = search(call, motion, rest, (edge_question){.beyond = c->clear_beyond}, &r);
  if (status < 0) return status;
  if (r.verdict == CPROX_VERDICT_VIOLATED && r.upper > c->hit_within) {
    out->nodes += r.nodes;
    r = (cprox_result){0};
    status = search(call, motion, rest, (edge_question){.beyond = c->hit_within}, &r);
    if (status < 0) return status;
    if (r.verdict == CPROX_VERDICT_CLEAR) r.verdict = CPROX_VERDICT_UNDECIDED;
  }
  take_search(call, rest, &r, out);
  return status;
}

static cprox_status ask_search(const edges_call *call, const double *from, const double *to, const edge_rest *rest,
                               cprox_edge_result *out) {
  if (rest->n_pairs + rest->n_self_pairs == 0) {
    out->verdict = CPROX_VERDICT_CLEAR;
    return CPROX_OK;
  }
  cprox_motion *motion = NULL;
  cprox_status status = create_motion(call, from, to, &motion);
  if (status < 0) return status;
  status = search_both(call, motion, rest, out);
  cprox_motion_free(motion);
  return status;
}

/* Of an edge that is not clear. */
static cprox_status find_first(const edges_call *call, const double *from, const double *to, cprox_edge_result *out) {
  const edge_rest all = all_of(call->c);
  cprox_motion *motion = NULL;
  cprox_status status = create_motion(call, from, to, &motion);
  if (status < 0) return status;
  cprox_result r = {0};
  status = search(call, motion, &all, (edge_question){.first = true}, &r);
  cprox_motion_free(motion);
  if (status < 0) return status;
  const cprox_verdict known = out->verdict;
  out->t_free = r.t_contact_lower, out->nodes += r.nodes;
  if (r.verdict == CPROX_VERDICT_VIOLATED) take_search(call, &all, &r, out);
  out->verdict = known == CPROX_VERDICT_UNDECIDED ? r.verdict : known;
  return CPROX_OK;
}

static void take_contact(const edges_call *call, const edge_found *found, cprox_edge_result *out) {
  out->verdict = CPROX_VERDICT_VIOLATED, out->t = 0.5 + (double)found->at;
  out->geometry = found->geometry;
  out->other = found->other + (found->self ? (int32_t)obstacles_count(call->c->asked.obstacles) : 0);
}

/* Measures what lanes left open, where and when it is deepest. */
static cprox_status measure(const edges_call *call, const double *from, const double *to, const edge_found *found,
                            cprox_edge_result *out) {
  const cprox_robot_pair pair = {found->geometry, found->other};
  const edge_rest one = {.pairs = &pair,
                         .self_pairs = &pair,
                         .n_pairs = !found->self,
                         .n_self_pairs = found->self,
                         .from = 0.5 + (double)found->at,
                         .to = 1.0,
                         .at_once = true};
  cprox_motion *motion = NULL;
  cprox_status status = create_motion(call, from, to, &motion);
  if (status < 0) return status;
  cprox_result r = {0};
  status = search(call, motion, &one, (edge_question){.beyond = call->c->hit_within}, &r);
  cprox_motion_free(motion);
  if (status < 0) return status;
  out->nodes += r.nodes;
  if (r.verdict != CPROX_VERDICT_VIOLATED) return CPROX_OK;
  take_contact(call, found, out);
  out->level = CPROX_EDGE_MEASUREMENT;
  return status;
}

static cprox_status ask_lanes(edges_call *call, const double *from, const double *to, cprox_edge_result *out) {
  const cprox_edge_checker *c = call->c;
  const edge_rest all = all_of(c);
  if (!c->in_lanes || !edge_motion_fill(c, from, to, &call->motion)) return ask_search(call, from, to, &all, out);
  edge_found found;
  for (int with = 1; with >= 0; with--) {
    call->lanes.open.edge++, call->lanes.suspects = with;
    call->kernel(c, &call->motion, &call->lanes, &found);
    out->intervals += found.intervals;
    if (!found.is_suspect) break;
    const cprox_status status = measure(call, from, to, &found, out);
    if (status < 0 || out->verdict == CPROX_VERDICT_VIOLATED) return status;
  }
  out->verdict = found.verdict, out->level = found.level;
  if (found.verdict == CPROX_VERDICT_VIOLATED) take_contact(call, &found, out);
  if (found.verdict != CPROX_VERDICT_UNDECIDED) return CPROX_OK;
  if (found.too_much) return ask_search(call, from, to, &all, out);
  const edge_rest open = open_of(call);
  return ask_search(call, from, to, &open, out);
}

static bool is_finite(const double *row, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (!isfinite(row[i])) return false;
  return true;
}

static cprox_status ask_edge(edges_call *call, size_t index, const double *from, const double *to,
                             cprox_edge_result *out) {
  const size_t n = call->c->robot->n_variables;
  *out = (cprox_edge_result){.verdict = CPROX_VERDICT_UNDECIDED, .t = NAN, .geometry = -1, .other = -1};
  cprox_status status;
  if (!is_finite(from, n) || !is_finite(to, n))
    status = workspace_fail(call->workspace, CPROX_INVALID, "edge %zu has a value that is not finite", index);
  else {
    status = ask_lanes(call, from, to, out);
    if (status >= 0 && call->c->asked.first && out->verdict != CPROX_VERDICT_CLEAR)
      status = find_first(call, from, to, out);
  }
  if (status < 0) out->verdict = CPROX_VERDICT_UNDECIDED, out->status = status;
  if (out->verdict == CPROX_VERDICT_CLEAR) out->t_free = 1.0;
  return out->status;
}

cprox_status cprox_robot_edges(const cprox_edge_checker *checker, const double *from, const double *to, size_t n,
                               cprox_workspace *workspace, uint8_t *verdicts, cprox_edge_result *results) {
  WORKSPACE_USE(workspace);
  if (!workspace) return CPROX_INVALID;
  workspace_clear(workspace);
  if (!checker) return workspace_fail(workspace, CPROX_INVALID, "checker is NULL");
  if (n > 0 && (!from || !to || !verdicts))
    return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", !from ? "from" : !to ? "to" : "verdicts");
  edges_call call = {.c = checker, .workspace = workspace};
  if (!begin(&call)) return workspace_fail(workspace, CPROX_MEMORY, "no memory for an edge");
  const size_t width = checker->robot->n_variables;
  cprox_status worst = CPROX_OK;
  char why[WHY] = ""; /* later edges forget the error message */
  for (size_t i = 0; i < n; i++) {
    cprox_edge_result r;
    const cprox_status status = ask_edge(&call, i, from + i * width, to + i * width, &r);
    verdicts[i] = (uint8_t)r.verdict;
    if (results) results[i] = r;
    if (worst < 0 || (status >= 0 && status <= worst)) continue;
    worst = status;
    strncpy(why, cprox_workspace_error(workspace), sizeof why - 1);
  }
  return worst == CPROX_OK ? CPROX_OK : workspace_fail(workspace, worst, "%s", why);
}
