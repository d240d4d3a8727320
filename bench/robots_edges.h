/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of robots among the obstacles of a scene, as all methods see them. */
#ifndef CPROX_BENCH_ROBOTS_EDGES_H
#define CPROX_BENCH_ROBOTS_EDGES_H

#include "peers/edge_validator.h"
#include "peers/robot_fcl.h"
#include "support/measure.h"
#include "support/robot_case.h"

enum { EDGES = 4096, MOST_JOINTS = 12, MOST_WORLDS = 64 };

/* What a robot is made of. */
typedef enum edge_shapes { BY_BALLS, BY_HULLS, BY_MESHES } edge_shapes;

/* A robot, what it turns [rad], and in whose scenes it stands. */
typedef struct edge_robot {
  const char *parameter, *name, *scenes;
  edge_shapes shapes;
  bool two_arms; /* two of the named robot beside each other */
  bool beside;   /* beside other libraries: cylinders of the scene are capsules, which all of them have */
  int joints;
  double low[MOST_JOINTS], high[MOST_JOINTS];
} edge_robot;

/* A robot among what stands. */
typedef struct edge_world {
  const edge_robot *moves;
  const cprox_robot *robot;
  const robot_case *model;
  cprox_obstacle targets[CASE_MAX_OBJECTS];
  size_t n_targets;
  cprox_body *made[CASE_MAX_OBJECTS]; /* targets that are of this world alone */
  cprox_obstacles *obstacles;
  cprox_edge_checker *checker;
  cprox_edge_checker *cloud; /* of the same scene as points, or NULL */
  robot_fcl *fcl;            /* or NULL */
  edge_validator *validator; /* or NULL */
} edge_world;

typedef struct edge_problem {
  const edge_world *world;
  double from[CASE_MAX_VARIABLES], to[CASE_MAX_VARIABLES];
  bool valid;
} edge_problem;

typedef struct edge_state {
  cprox_workspace *workspace;
  double per_radian;
} edge_state;

/* Methods: proven; by samples of the core's own lanes, of FCL, of a validator that was compiled apart. */
void edge_certified(const void *problems, size_t i, void *state, bench_answer *answer);
void edge_by_lanes(const void *problems, size_t i, void *state, bench_answer *answer);
void edge_by_fcl(const void *problems, size_t i, void *state, bench_answer *answer);
void edge_by_validator(const void *problems, size_t i, void *state, bench_answer *answer);

/* The worlds of other libraries, where they are installed and know the robot. */
void edge_world_ready_peers(edge_world *world);

/* Edges beside samples from coarse to fine: what these cost, and how many verdicts are wrong. */
void edge_rows_of_samples(const edge_robot *robot, const char *workload, const edge_problem *problems, size_t n,
                          const bench_size *size, cprox_workspace *ws);

/* Judges all edges of a robot of balls by support/edge_truth.h, and says on standard error which verdicts it doubts. */
void edge_judge(edge_problem *problems, size_t n);

/* Which level decided how many edges, over how near they come to the scene. */
void edge_rows_of_levels(const edge_robot *robot, const edge_problem *problems, size_t n, const bench_size *size,
                         cprox_workspace *ws);

#endif
