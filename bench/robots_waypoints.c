/* SPDX-License-Identifier: BSD-3-Clause */
/* One straight motion of a robot, written with 2 to 100,000 waypoints: what the waypoints cost. In turns with each, the
 * same query of the motion with 2 waypoints. */
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

/* From where the arm begins to where it ends on its own trajectory, written with so many waypoints at unequal times. */
static cprox_motion *straight(const robot_case *arm, size_t points, cprox_workspace *ws) {
  double ends[2][CASE_MAX_VARIABLES];
  int32_t variables[CASE_MAX_VARIABLES];
  const size_t n = arm->n_variables;
  const cprox_motion_info info = cprox_motion_get_info(arm->motion);
  cprox_motion_evaluate(arm->motion, info.t0, ends[0]);
  cprox_motion_evaluate(arm->motion, info.t1, ends[1]);
  double *values = malloc(points * n * sizeof *values);
  cprox_waypoint *list = calloc(points, sizeof *list);
  rng r = rng_seed(92);
  for (size_t i = 0; i < n; i++) variables[i] = (int32_t)i;
  for (size_t i = 0; i < points; i++) {
    const bool inside = i > 0 && i + 1 < points;
    const double s = ((double)i + (inside ? rng_uniform(&r, -0.3, 0.3) : 0.0)) / (double)(points - 1);
    for (size_t k = 0; k < n; k++) values[i * n + k] = (1.0 - s) * ends[0][k] + s * ends[1][k];
    list[i] = (cprox_waypoint){.time = s, .positions = values + i * n};
  }
  cprox_motion *motion = NULL;
  const cprox_motion_description d = {.variables = variables,
                                      .n_variables = n,
                                      .waypoints = list,
                                      .n_waypoints = points,
                                      .interpolation = CPROX_INTERPOLATION_LINEAR};
  if (cprox_motion_create(arm->robot, &d, ws, &motion) != CPROX_OK)
    fprintf(stderr, "waypoints: %s\n", cprox_workspace_error(ws));
  free(values);
  free(list);
  return motion;
}

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
