/* SPDX-License-Identifier: BSD-3-Clause */
/* A robot, or two or three of these and bodies on pose splines on one clock, with bodies of many kinds on their links,
 * and obstacles: how they are drawn, where they are at a time in long double (support/robots.h), and how near two
 * bodies come there by nearest points by definition (bodies.h). */
#ifndef CPROX_ATTACK_ROBOT_WORLD_H
#define CPROX_ATTACK_ROBOT_WORLD_H

#include "attack.h"
#include "bodies.h"
#include "support/robots.h"

enum {
  OBSTACLES = 3,
  SAMPLES = 16,
  MEMBERS = 3,
  MOST_GEOMETRIES = MEMBERS * TEST_MAX_LINKS,
  MOST_PAIRS = MOST_GEOMETRIES * (MOST_GEOMETRIES + OBSTACLES)
};

/* Two bodies: a geometry, and an obstacle or another geometry. */
typedef struct pair {
  size_t geometry, other;
  bool self;
} pair;

/* A body and its margin lie in it. */
typedef struct ball {
  vec3l centre; /* in the frame of the link; of an obstacle in the world */
  long double radius;
} ball;

/* Where everything is at one time, with some of the possible starts. */
typedef struct view {
  double t, place[MEMBERS];
  ref_pose links[MOST_GEOMETRIES];
  vec3l centres[MOST_GEOMETRIES]; /* of the balls */
} view;

typedef struct world {
  attack *a;
  rng *r;
  bool several, vague;                  /* starts have tolerances */
  test_robot members[MEMBERS];          /* one geometry a link */
  size_t n_members, first[MEMBERS + 1]; /* their geometries */
  double starts[MEMBERS], tolerances[MEMBERS];
  double place[MEMBERS]; /* in [0, 1]: which of the possible starts; of what may be anywhere, where it is */
  cprox_pose bases[MEMBERS];
  cprox_robot *joined; /* of several */
  cprox_motion *motion;
  bool across; /* of the pairs with itself only those of two members */
  cprox_robot_pair pairs[MOST_PAIRS];
  random_body links[MOST_GEOMETRIES], bodies[OBSTACLES];
  cprox_pose poses[OBSTACLES];
  double margins[OBSTACLES];
  cprox_obstacle targets[OBSTACLES];
  ball link_balls[MOST_GEOMETRIES], body_balls[OBSTACLES];
  bool self, obstacles; /* what is asked about */
  pair asked[MOST_PAIRS];
  size_t n_asked;
  cprox_mover mover;
  double t0, t1;
  view views[SAMPLES];
} world;

/* False: the case cannot be drawn; w->a says whether that is a fault. */
bool world_make(world *w, double scale);
/* The bodies of links belong to the robot: robot_free() frees them. */
void world_free(world *w);

/* ---- what is where ---- */

size_t count_geometries(const world *w);
size_t member_of(const world *w, size_t g);
/* The link of a geometry in the robot that is asked about. */
int32_t link_of(const world *w, size_t g);

typedef struct placed {
  const random_body *body;
  ref_pose link;     /* in the world; of an obstacle the identity */
  cprox_pose offset; /* of the body in it */
  double margin;
} placed;

/* The link of a geometry. */
ref_pose place_link(const world *w, size_t g, const double *place, long double time);
/* The links of all geometries. */
void place_links(const world *w, view *v);
placed place_geometry(const world *w, const ref_pose *link, size_t g);
placed place_obstacle(const world *w, size_t o);
/* The geometry and the other body of a pair. */
void place_pair(const world *w, pair p, const double *place, long double time, placed two[2]);

/* ---- how near two bodies are ---- */

/* Bounds of the distance of a pair at one time, margins taken off and not cut at 0. */
typedef struct gap {
  long double upper, lower;
  long double room; /* of the bodies that the core was given */
} gap;

vec3l nearest_on(const placed *s, vec3l x);
/* By nearest points taken in turns. They end where planes prove that the pair is not below `limit`, by bounds that are
 * near enough to compare times by, or that it is not below `best`. They begin at a point of the link of a, which moves
 * to the last nearest one. */
gap gap_between(const placed *a, const placed *b, long double limit, long double best, vec3l *begin);
gap gap_at(const world *w, pair p, double time);

#endif
