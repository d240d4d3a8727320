/* SPDX-License-Identifier: BSD-3-Clause */
/* One straight motion of a robot, written with 2 to 100,000 waypoints: what the waypoints cost. In turns with each, the
 * same query of the motion with 2 waypoints. And what making the motion costs, all of its joints moving. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "robots.h"
#include "solve/list.h"
#include "support/random.h"

typedef enum asked { DISTANCE, TOLERANCE, TIME_OF_CONTACT } asked;

enum { ARMS = 8, MOST_POINTS = 100000 };

typedef struct problem {
  cprox_mover dense, sparse;
  const cprox_obstacle *targets;
  size_t n;
  asked asked;
  double delta;
} problem;

typedef struct method_state {
  cprox_workspace *workspace;
  bool sparse;
} method_state;

static void ask(const void *problems, size_t i, void *state, bench_answer *answer) {
  const problem *p = (const problem *)problems + i;
  const method_state *s = state;
  const cprox_mover mover = s->sparse ? p->sparse : p->dense;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-4;
  cprox_result r;
  cprox_status status = CPROX_OK;
  if (p->asked == DISTANCE) status = list_distance(mover, p->targets, p->n, &options, s->workspace, &r, NULL);
  if (p->asked == TOLERANCE)
    status = list_tolerance(mover, p->targets, p->n, p->delta, &options, s->workspace, &r, NULL);
  if (p->asked == TIME_OF_CONTACT) status = list_time_of_contact(mover, p->targets, p->n, &options, s->workspace, &r);
  *answer = (bench_answer){.nodes = r.nodes, .distance_queries = r.distance_queries, .failed = status != CPROX_OK};
  if (p->asked == TOLERANCE) answer->wrong = r.verdict != CPROX_VERDICT_CLEAR;
  if (p->asked == DISTANCE) answer->lower = r.lower, answer->upper = r.upper;
}

/* From where the arm begins to where it ends on its own trajectory, with so many waypoints at unequal times. */
typedef struct waypoints {
  cprox_motion_description description;
  int32_t variables[CASE_MAX_VARIABLES];
  double *values;
  cprox_waypoint *list;
} waypoints;

static void draw_waypoints(const robot_case *arm, size_t points, waypoints *w) {
  double ends[2][CASE_MAX_VARIABLES];
  const size_t n = arm->n_variables;
  const cprox_motion_info info = cprox_motion_get_info(arm->motion);
  cprox_motion_evaluate(arm->motion, info.t0, ends[0]);
  cprox_motion_evaluate(arm->motion, info.t1, ends[1]);
  w->values = malloc(points * n * sizeof *w->values);
  w->list = calloc(points, sizeof *w->list);
  rng r = rng_seed(92);
  for (size_t i = 0; i < n; i++) w->variables[i] = (int32_t)i;
  for (size_t i = 0; i < points; i++) {
    const bool inside = i > 0 && i + 1 < points;
    const double s = ((double)i + (inside ? rng_uniform(&r, -0.3, 0.3) : 0.0)) / (double)(points - 1);
    for (size_t k = 0; k < n; k++) w->values[i * n + k] = (1.0 - s) * ends[0][k] + s * ends[1][k];
    w->list[i] = (cprox_waypoint){.time = s, .positions = w->values + i * n};
  }
  w->description = (cprox_motion_description){.variables = w->variables,
                                              .n_variables = n,
                                              .waypoints = w->list,
                                              .n_waypoints = points,
                                              .interpolation = CPROX_INTERPOLATION_LINEAR};
}

static void free_waypoints(waypoints *w) {
  free(w->values);
  free(w->list);
}

static cprox_motion *straight(const robot_case *arm, size_t points, cprox_workspace *ws) {
  waypoints w;
  draw_waypoints(arm, points, &w);
  cprox_motion *motion = NULL;
  if (cprox_motion_create(arm->robot, &w.description, ws, &motion) != CPROX_OK)
    fprintf(stderr, "waypoints: %s\n", cprox_workspace_error(ws));
  free_waypoints(&w);
  return motion;
}

/* ---- making a motion ---- */

typedef struct making {
  const cprox_robot *robot;
  waypoints w;
} making;

static void make_motion(const void *problems, size_t i, void *state, bench_answer *answer) {
  const making *p = (const making *)problems + i;
  cprox_motion *motion = NULL;
  *answer = (bench_answer){.lower = NAN, .upper = NAN};
  answer->failed = cprox_motion_create(p->robot, &p->w.description, state, &motion) != CPROX_OK;
  cprox_motion_free(motion);
}

static void making_row(const robot_case *arm, size_t points, const bench_size *size, cprox_workspace *ws) {
  making p = {.robot = arm->robot};
  draw_waypoints(arm, points, &p.w);
  size_t joints = 0;
  for (size_t k = 0; k < arm->n_variables; k++)
    joints += p.w.values[k] != p.w.values[(points - 1) * arm->n_variables + k];
  char parameter[60];
  snprintf(parameter, sizeof parameter, "waypoints %zu of %zu joints", points, joints);
  const bench_workload w = {"robots", "making a motion", parameter, &p, 1, NULL, 0.0};
  const bench_method method = {"curve_proximity", make_motion, ws};
  bench_measure(&w, size, &method, 1);
  free_waypoints(&p.w);
}

/* ---- queries ---- */

/* Motions that reach contact are asked when; the others how near they come. */
static double distance_of(const problem *p, cprox_workspace *ws) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  cprox_result r = {.upper = 0.0};
  list_distance(p->sparse, p->targets, p->n, &options, ws, &r, NULL);
  return r.upper;
}

static void row(const char *name, size_t points, const problem *problems, size_t n, const bench_size *size,
                cprox_workspace *ws) {
  method_state dense = {.workspace = ws}, sparse = {.workspace = ws, .sparse = true};
  char parameter[40];
  snprintf(parameter, sizeof parameter, "waypoints %zu", points);
  const bench_workload w = {"robots", name, parameter, problems, n, NULL, 0.0};
  const bench_method methods[] = {{"curve_proximity", ask, &dense}, {"two waypoints", ask, &sparse}};
  if (n > 0) bench_measure(&w, size, methods, 2);
}

void bench_robot_waypoints(const robot_case *cases, size_t n_cases, const bench_size *size, cprox_workspace *ws) {
  static const size_t COUNTS[] = {2, 10, 100, 1000, 10000, MOST_POINTS};
  for (size_t k = 0; k < sizeof COUNTS / sizeof *COUNTS && bench_wanted(size, "making a motion"); k++)
    making_row(&cases[0], COUNTS[k], size, ws);
  if (!bench_wanted(size, "waypoints")) return;
  cprox_motion *sparse[ARMS], *dense[ARMS];
  const robot_case *arms[ARMS];
  size_t n_arms = 0;
  for (size_t i = 0; i < n_cases && n_arms < ARMS; i += 3) {
    sparse[n_arms] = straight(&cases[i], 2, ws);
    arms[n_arms++] = &cases[i];
  }
  for (size_t k = 0; k < sizeof COUNTS / sizeof *COUNTS; k++) {
    problem self[ARMS], scene[ARMS], tolerance[2 * ARMS], contact[ARMS], touching[ARMS];
    size_t n_self = 0, n_scene = 0, n_tolerance = 0, n_contact = 0, n_touching = 0;
    for (size_t i = 0; i < n_arms; i++) {
      dense[i] = straight(arms[i], COUNTS[k], ws);
      problem p = {.dense = cprox_robot_self(dense[i], arms[i]->self_pairs, arms[i]->n_self_pairs),
                   .sparse = cprox_robot_self(sparse[i], arms[i]->self_pairs, arms[i]->n_self_pairs)};
      const double of_itself = distance_of(&p, ws);
      if (of_itself > 0.0) {
        self[n_self++] = p;
        p.asked = TOLERANCE, p.delta = 0.9 * of_itself;
        tolerance[n_tolerance++] = p;
      }
      p = (problem){.dense = cprox_robot_along(dense[i], NULL, 0),
                    .sparse = cprox_robot_along(sparse[i], NULL, 0),
                    .targets = arms[i]->targets,
                    .n = arms[i]->n_targets};
      const double from_scene = distance_of(&p, ws);
      if (from_scene > 0.0) {
        scene[n_scene++] = p;
        p.asked = TOLERANCE, p.delta = 0.9 * from_scene;
        tolerance[n_tolerance++] = p;
      } else {
        touching[n_touching++] = p;
      }
      p.asked = TIME_OF_CONTACT;
      contact[n_contact++] = p;
    }
    row("waypoints distance of itself", COUNTS[k], self, n_self, size, ws);
    row("waypoints distance of the scene", COUNTS[k], scene, n_scene, size, ws);
    row("waypoints distance of a scene in contact", COUNTS[k], touching, n_touching, size, ws);
    row("waypoints tolerance", COUNTS[k], tolerance, n_tolerance, size, ws);
    row("waypoints time of contact", COUNTS[k], contact, n_contact, size, ws);
    for (size_t i = 0; i < n_arms; i++) cprox_motion_free(dense[i]);
  }
  for (size_t i = 0; i < n_arms; i++) cprox_motion_free(sparse[i]);
}
