/* SPDX-License-Identifier: BSD-3-Clause */
/* Random robots of balls and capsules on random straight edges among random obstacles, and the least distance on an edge
 * by samples, with kinematics and speeds of their own. */
#ifndef CPROX_TEST_EDGE_WORLDS_H
#define CPROX_TEST_EDGE_WORLDS_H

#include "curve_proximity/cprox/edges.h"
#include "support/robots.h"

enum {
  EDGE_WORLD_BALLS = 3 * TEST_MAX_LINKS,
  EDGE_WORLD_OBSTACLES = 6,
  EDGE_WORLD_KINDS = 8, /* of bodies */
  EDGE_WORLD_EDGES = 8, /* in a world */
  EDGE_WORLD_SAMPLES = 256,
  EDGE_WORLD_PAIRS = EDGE_WORLD_BALLS * (EDGE_WORLD_OBSTACLES + EDGE_WORLD_BALLS)
};

typedef struct edge_robot {
  test_robot t; /* its links */
  cprox_link_geometry geometries[EDGE_WORLD_BALLS];
  double radius[EDGE_WORLD_BALLS], half[EDGE_WORLD_BALLS]; /* half > 0: a capsule */
  size_t n;
  cprox_robot *robot;
} edge_robot;

typedef struct edge_world {
  edge_robot b;
  cprox_obstacle targets[EDGE_WORLD_OBSTACLES];
  size_t n;
  cprox_obstacles *set;
  /* with obstacles, and of geometries on links that are no neighbours */
  cprox_robot_pair pairs[EDGE_WORLD_BALLS * EDGE_WORLD_OBSTACLES], selves[EDGE_WORLD_BALLS * EDGE_WORLD_BALLS];
  size_t n_pairs, n_selves;
} edge_world;

/* A robot with all joints but floating ones, which lanes do not take; lengths by `scale` [m]. */
void edge_robot_make(rng *r, double scale, bool capsules, edge_robot *b);
void edge_robot_free(edge_robot *b);

/* An edge of it, rows of all variables: up to 3 rad, or 3 times the scale where a variable shifts. */
void edge_robot_draw(rng *r, const edge_robot *b, double scale, double *from, double *to);

/* The links at t in [0, 1] of an edge, in long double. */
void edge_robot_links(const edge_robot *b, const double *from, const double *to, long double t, ref_pose *links);

/* A point of a geometry's line: -1 … 1 along a capsule, else the centre. */
vec3l edge_robot_centre(const edge_robot *b, const ref_pose *links, size_t geometry, double along);

/* One of EDGE_WORLD_KINDS bodies, up to `size` [m] large. */
cprox_body *edge_world_body(rng *r, double size, size_t kind);

/* `thin`: obstacles are wires, pins and plates, up to ten thousand times as long as thick. */
void edge_world_make(rng *r, double scale, bool capsules, bool thin, edge_world *w);
void edge_world_free(edge_world *w);

/* All pairs of a world; `self`: of the robot with itself, too. */
cprox_edge_query edge_world_asks(const edge_world *w, bool self, double delta);

/* A checker. Fails the running test where the core refuses it. */
cprox_edge_checker *edge_world_checker(const cprox_robot *robot, const cprox_edge_query *q);

/* The least distance of the pairs at t of an edge, in double precision; capsules by nine points of their lines. */
double edge_world_distance(const edge_world *w, const double *from, const double *to, double t, bool self);

/* The least of EDGE_WORLD_SAMPLES samples of an edge, refined round the least of them down to 1e-7 of the edge; *at:
 * where. A pair is measured again where it may be nearer than the least so far: its distance changes by no more than
 * both sides' speeds. */
double edge_world_least(const edge_world *w, const double *from, const double *to, bool self, double *at);

/* Fails the running test where a verdict is wrong: what is clear must be, with `least` the least distance; what is
 * violated must be so where it says. Tolerance: 1e-9 of the scale, for poses and distances in double on either side. */
void edge_world_check(const edge_world *w, const cprox_edge_query *q, const cprox_edge_result *r, uint8_t verdict,
                      const double *from, const double *to, double scale, bool self, double least);

/* So many worlds, EDGE_WORLD_EDGES edges each: fails the running test where a verdict is wrong. Counts verdicts and
 * levels. */
void edge_world_try(uint64_t seed, size_t worlds, bool thin, size_t counts[3], size_t levels[CPROX_EDGE_SEARCH + 1]);

#endif
