/* SPDX-License-Identifier: BSD-3-Clause */
/* Random queries of every kind that certificates can be made for, and their text for the checkers. */
#ifndef CHECK_TEST_QUERIES_H
#define CHECK_TEST_QUERIES_H

#include <stdio.h>

#include "check.h"
#include "curve_proximity/cprox.h"
#include "support/meshes.h"
#include "support/random.h"

enum { QUERY_MAX_POINTS = 40, QUERY_MAX_TARGETS = 3, QUERY_MAX_BODIES = 24 };

/* A curve as it was given. */
typedef struct given_curve {
  const char *basis;
  size_t degree, n, n_knots;
  double t0, t1;
  vec3 points[QUERY_MAX_POINTS];
  double knots[QUERY_MAX_POINTS + 12];
  cprox_curve *curve;
} given_curve;

/* A mesh that is not convex, with its hull: the body of both, the mesh, the hull; to be freed in this order. And its
 * triangles. Or elements without a hull: `mesh` and `hull` are NULL. Points are triangles of no size, cells those of
 * their corners: */
typedef struct query_mesh {
  cprox_body *body, *mesh, *hull;
  test_mesh surface;
  double radius; /* balls round points */
  bool cells;    /* twelve triangles each */
} query_mesh;

typedef struct asked {
  given_curve mover;
  double radius;
  size_t n;
  cprox_obstacle targets[QUERY_MAX_TARGETS];
  given_curve target_curve; /* of a target that is a curve, curve NULL: none */
  given_curve growth;       /* of the mover's radius, likewise; */
  given_curve ride, swell;  /* what the first target rides, and its growth */
  const cprox_body *carried;
  cprox_body *bodies[QUERY_MAX_BODIES];
  size_t n_bodies;
  query_mesh mesh[QUERY_MAX_TARGETS]; /* of a target that is a mesh; body NULL: it is none */
  double scale;                       /* of the sizes [m] */
} asked;

/* What may be asked. */
typedef struct asked_kinds {
  bool bezier_only; /* curves of the other bases, too */
  bool polytope_only;
  bool curve_target;
  bool meshes;   /* half of the targets */
  bool elements; /* those of any kind, too */
  bool implicit; /* half of the other bodies */
  bool clock;    /* radii that change, and a first target on the mover's clock */
  bool carried;  /* bodies that are carried */
  bool stays;    /* a mover that stays where it begins; its curve is a Bézier curve */
} asked_kinds;

/* Of any convex kind. */
cprox_body *query_body(rng *r, double scale, bool polytope_only, cprox_workspace *ws);

/* A superquadric, a hyperquadric, or an intersection of inequalities. */
cprox_body *query_implicit(rng *r, double scale, cprox_workspace *ws);

query_mesh query_mesh_random(rng *r, double scale, cprox_mesh_fill fill, cprox_workspace *ws);
/* A mesh without a hull, points, or cells. */
query_mesh query_elements_random(rng *r, double scale, cprox_workspace *ws);

/* From a point of its own frame, by every element; 0 inside. */
double query_mesh_distance(const query_mesh *mesh, vec3l p);

void query_mesh_free(query_mesh *mesh);

/* Fills q, which must stay where it is. Sizes around `scale`, everything `away` from the origin. */
void asked_random(asked *q, rng *r, asked_kinds kinds, double scale, double away, cprox_workspace *ws);
void asked_free(asked *q);

/* The head and the targets, then the mover under a name. */
void asked_write_targets(const asked *q, FILE *out);
void asked_write_mover(const asked *q, const char *id, FILE *out);

cprox_mover asked_mover(const asked *q);

/* A query that the checker has read. */
typedef struct asked_text {
  problem read;
  FILE *file;
  char *text;
} asked_text;

asked_text asked_text_of(const asked *q);
void asked_text_free(asked_text *text);

/* What the checker finds. */
finding asked_check(const asked *q, const void *bytes, size_t size);

#endif
