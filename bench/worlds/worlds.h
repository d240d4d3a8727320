/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files of the group share. */
#ifndef CPROX_BENCH_WORLDS_H
#define CPROX_BENCH_WORLDS_H

#include "curve_proximity/cprox.h"
#include "peers/worlds.h"
#include "support/measure.h"
#include "support/random.h"

enum { WORLDS_POINTS = 6, WORLDS_SAMPLES = 100 };
static const double WORLDS_EPSILON = 1e-6;

/* A curve, what it is asked against, and what that is to the peer. */
typedef struct worlds_problem {
  vec3 points[WORLDS_POINTS];
  cprox_curve *curve;
  cprox_body *ball; /* at the curve's middle, for queries about one ball */
  cprox_pose middle;
  double radius;
  cprox_obstacle target;
  const cprox_obstacles *set;
  const cprox_obstacle *targets;
  size_t n_targets;
  const world_peer *peer;
  bool hits;
} worlds_problem;

typedef struct worlds_asked {
  cprox_workspace *ws;
} worlds_asked;

/* ---- what is asked about (shapes.c) ---- */

typedef struct worlds_mesh {
  size_t n, m;
  vec3 *vertices;
  uint32_t (*triangles)[3];
} worlds_mesh;

/* An octahedron's faces cut into k² each and laid on a sphere with bumps: 8 k² triangles, for the caller to free. */
worlds_mesh worlds_mesh_make(uint32_t k);

/* On the floor, two walls and forty blocks of a room of 10 x 10 x 3 m, with a millimetre's noise. */
vec3 worlds_in_room(rng *r);

/* The centres of up to n cells of the room's octree, each once; how many. */
size_t worlds_cells_make(rng *r, size_t n, double width, vec3 *centres);

/* ---- problems (problems.c) ---- */

/* Ends the program with the workspace's reason where the status is negative. */
void worlds_check(cprox_status status, const cprox_workspace *ws);

/* malloc() that ends the program where memory is out. */
void *worlds_get(size_t bytes);

/* A curve of the scale that begins within the half width of the centre. */
void worlds_curve_make(rng *r, worlds_problem *p, vec3 centre, vec3 half, double scale);

cprox_mover worlds_mover(const worlds_problem *p);
cprox_options worlds_options(double epsilon);
void worlds_take(const cprox_result *r, bench_answer *a);

/* Seconds of this thread. */
double worlds_now(void);

/* The row of a construction: its time, and in the column nodes the bytes of an element. */
void worlds_say_build(const char *what, size_t n, double seconds, const cprox_body *body);

/* ---- workloads ---- */

/* What a body is called in the rows, and where curves of which scale run about it. */
typedef struct worlds_scene {
  const char *what, *parameter;
  const cprox_body *body;
  const world_peer *peer;
  vec3 centre, half;
  double scale;
} worlds_scene;

/* All that is asked of one body (bodies.c). */
void worlds_ask_body(const worlds_scene *scene, rng *r, const bench_size *size, worlds_asked *q);

/* A million points of which some move (updates.c). */
void worlds_ask_updates(const bench_size *size, worlds_asked *q);

/* Boxes at one density (sets.c). */
void worlds_ask_sets(const bench_size *size, worlds_asked *q);

#endif
