/* SPDX-License-Identifier: BSD-3-Clause */
/* Queries about robots as text, and random ones with bodies of every kind that certificates know. */
#ifndef CHECK_TEST_ROBOT_QUERIES_H
#define CHECK_TEST_ROBOT_QUERIES_H

#include <stdio.h>

#include "check.h"
#include "curve_proximity/cprox.h"
#include "support/queries.h"
#include "support/robots.h"

enum {
  ROBOT_QUERY_MOST = 64,
  ROBOT_QUERY_TARGETS = 4,
  ROBOT_QUERY_BODIES = TEST_MAX_LINKS + ROBOT_QUERY_TARGETS,
  ROBOT_QUERY_LOOSE = 2 * ROBOT_QUERY_BODIES
};

/* A body that flies beside the robot and turns by slerp. */
typedef struct robot_flyer {
  cprox_body *body;
  cprox_robot *robot, *joined;
  cprox_motion *motion, *together;
  double start; /* [s] of the robot's motion: that of the body starts at 0 */
} robot_flyer;

typedef struct robot_query {
  test_robot robot;
  robot_flyer flyer; /* body NULL: there is none */
  cprox_obstacle targets[ROBOT_QUERY_TARGETS];
  size_t n;
  cprox_body *loose[ROBOT_QUERY_LOOSE]; /* what unions are made of */
  size_t n_loose;
  query_mesh mesh[ROBOT_QUERY_BODIES]; /* their bodies are those of links and targets */
  size_t n_meshes;
  cprox_mover mover; /* along, or against itself */
} robot_query;

/* speed: as robot_make(). apart: how far the targets are from the robot's base [m]. meshes: a third of the bodies. */
void robot_query_random(robot_query *q, rng *r, double speed, double apart, bool meshes, cprox_workspace *ws);
void robot_query_free(robot_query *q);

/* One in three that has obstacles is asked about both at once. */
void robot_query_whole(robot_query *q, rng *r);

/* A body flies beside the robot, on one clock with it. A query about the robot itself becomes one about both. */
void robot_query_fly(robot_query *q, rng *r, cprox_workspace *ws);

/* The mover after a change of the robot's motion. */
void robot_query_renew(robot_query *q, cprox_workspace *ws);

/* Bodies by inequalities take the place of half of the targets. */
void robot_query_inequalities(robot_query *q, rng *r, cprox_workspace *ws);

/* The head and the targets; then a robot. */
void robot_write_targets(const cprox_obstacle *targets, size_t n, FILE *out);
void robot_write_mover(const cprox_mover *along, const cprox_obstacle *targets, size_t n, const char *id,
                       cprox_workspace *ws, FILE *out);

/* A query that the checker has read. */
typedef struct robot_text {
  problem read;
  FILE *file;
} robot_text;

robot_text robot_text_of(const cprox_mover *along, const cprox_obstacle *targets, size_t n, cprox_workspace *ws);
finding robot_text_check(const robot_text *text, const void *bytes, size_t size);
void robot_text_free(robot_text *text);

#endif
