/* SPDX-License-Identifier: BSD-3-Clause */
/* Which level decided how many edges, over how near they come to the scene: the Panda by balls, by hulls, by meshes,
 * without itself, whose neighbouring links are always near. A row for each level and range of clearance: the median time of its edges, their number among all edges of that range
 * (distance_queries, nodes) and their share (error). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "robots_edges.h"

enum { RANGES = 7, LEVELS = 6, REPEATS = 5 };

/* Where ranges end [m]; the first one is of edges that touch. */
static const double UP_TO[RANGES] = {0.0, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1, INFINITY};
static const char *const RANGE[RANGES] = {"in contact",  "0 to 1 mm",    "1 to 3 mm",    "3 to 10 mm",
                                          "10 to 30 mm", "30 to 100 mm", "beyond 100 mm"};
static const char *const LEVEL[LEVELS] = {NULL,
                                          "decided by balls",
                                          "decided by covers",
                                          "decided by normals",
                                          "decided by a measurement",
                                          "decided by the search"};

static const char *const SHAPES[] = {"balls", "hulls", "meshes"};

/* The certified lower end of how near the robot comes to the scene. */
static double clearance_of(const edge_problem *p, cprox_workspace *ws) {
  int32_t variables[MOST_JOINTS];
  for (int32_t k = 0; k < MOST_JOINTS; k++) variables[k] = k;
  const cprox_waypoint ends[2] = {{.time = 0.0, .positions = p->from}, {.time = 1.0, .positions = p->to}};
  const cprox_motion_description edge = {.kind = CPROX_MOTION_WAYPOINTS,
                                         .variables = variables,
                                         .n_variables = (size_t)p->world->moves->joints,
                                         .waypoints = ends,
                                         .n_waypoints = 2,
                                         .interpolation = CPROX_INTERPOLATION_LINEAR,
                                         .rest = p->from};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-4;
  cprox_motion *along = NULL;
  if (cprox_motion_create(p->world->robot, &edge, ws, &along) < 0) return NAN;
  const cprox_mover mover = cprox_robot_along(along, NULL, 0);
  cprox_result r;
  const cprox_status status = cprox_obstacles_distance(p->world->obstacles, mover, &options, ws, &r, NULL);
  cprox_motion_free(along);
  return status < 0 ? NAN : r.lower;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* An edge, and its time [us]. */
static cprox_edge_result ask(const cprox_edge_checker *checker, const edge_problem *p, cprox_workspace *ws,
                             double *time) {
  uint8_t verdict;
  cprox_edge_result r = {.level = CPROX_EDGE_NONE};
  double times[REPEATS];
  for (int k = 0; k < REPEATS; k++) {
    const double began = bench_thread_seconds();
    cprox_robot_edges(checker, p->from, p->to, 1, ws, &verdict, &r);
    times[k] = 1e6 * (bench_thread_seconds() - began);
  }
  qsort(times, REPEATS, sizeof *times, ascending);
  *time = times[REPEATS / 2];
  return r;
}

void edge_rows_of_levels(const edge_robot *robot, const edge_problem *problems, size_t n, const bench_size *size,
                         cprox_workspace *ws) {
  static double times[RANGES][LEVELS][EDGES];
  size_t count[RANGES][LEVELS] = {{0}}, of[RANGES] = {0};
  if (!bench_wanted(size, "levels of edges") || strncmp(robot->name, "panda", 5) != 0) return;
  cprox_edge_checker *checker = NULL;
  for (size_t i = 0; i < n; i++) {
    if (i == 0 || problems[i].world != problems[i - 1].world) {
      const cprox_edge_query asked = {.obstacles = problems[i].world->obstacles, .without_self = true};
      cprox_edge_checker_free(checker);
      if (cprox_edge_checker_create(problems[i].world->robot, &asked, ws, &checker) != CPROX_OK) return;
    }
    double time;
    const cprox_edge_result r = ask(checker, &problems[i], ws, &time);
    int range = 0;
    if (r.verdict == CPROX_VERDICT_CLEAR) {
      const double clearance = clearance_of(&problems[i], ws);
      if (isnan(clearance)) continue;
      for (range = 1; range < RANGES - 1 && clearance > UP_TO[range];) range++;
    }
    times[range][r.level][count[range][r.level]++] = time;
    of[range]++;
  }
  cprox_edge_checker_free(checker);
  for (int range = 0; range < RANGES; range++)
    for (int level = 1; level < LEVELS && of[range] > 0; level++) {
      const size_t m = count[range][level];
      qsort(times[range][level], m, sizeof(double), ascending);
      printf("robots,levels of edges,%s,panda by %s: %s,%.4g,nan,%zu,%zu,%.4g,0,0\n", LEVEL[level],
             SHAPES[robot->shapes], RANGE[range], m ? times[range][level][m / 2] : NAN, of[range], m,
             (double)m / (double)of[range]);
    }
  fflush(stdout);
}
