/* SPDX-License-Identifier: BSD-3-Clause */
/* The query that certificates are about, read from text. All numbers are doubles and taken as exact. */
#ifndef CHECK_PROBLEM_H
#define CHECK_PROBLEM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef enum basis { BEZIER, BSPLINE, POLYNOMIAL, LEGENDRE, LAGRANGE, TRIGONOMETRIC } basis;

typedef struct curve {
  basis basis;
  size_t degree;
  double t0, t1;
  size_t n, n_knots;
  double (*points)[3];
  double *knots;
} curve;

typedef enum kind {
  POINT,
  SPHERE,
  BOX,
  CAPSULE,
  CYLINDER,
  CONE,
  ELLIPSOID,
  HALFSPACE,
  POLYTOPE,
  HULL,
  IMPLICIT,
  CURVE,
  /* unions of elements: triangles without or with the inside, balls about points, boxes along the axes */
  TRIANGLES,
  SOLID,
  POINTS,
  CELLS
} kind;

/* What a body satisfies, about its centre; sum_of: of each term the sum that it is part of. */
typedef struct inequalities {
  size_t n_planes, n_quadrics, n_sums, n_terms;
  double (*planes)[4], (*quadrics)[10], (*terms)[5];
  size_t *sum_of;
} inequalities;

/* position x y z, quaternion w x y z of any norm */
typedef struct pose {
  double x[3], q[4];
} pose;

/* A convex body, a curve or a union of elements, inside its poses (the outermost first), and a ball added to it. */
typedef struct set {
  kind kind;
  double margin;
  size_t n_poses;
  pose poses[2];
  double size[4];   /* as the text has them */
  double centre[3]; /* POINT, POLYTOPE, HULL, IMPLICIT, elements */
  size_t n;
  double (*vertices)[3];  /* about the centre; of elements `corners` each, in a row */
  size_t corners;         /* 0: it is no union of elements */
  double low[3], high[3]; /* of elements, a box round all vertices */
  curve curve;
  inequalities rows; /* IMPLICIT */
  curve ride;        /* within the first pose, all of it is moved by this at the mover's parameter; n 0: it stands */
  curve growth;      /* its x at the mover's parameter is added to the margin; n 0: nothing is */
  char name[64];     /* whose it is, or "" */
} set;

static inline size_t set_elements(const set *s) {
  return s->corners > 0 ? s->n / s->corners : 0;
}

static inline bool curve_is_there(const curve *c) {
  return c->n > 0;
}

/* The box round the vertices of the elements begin ... end - 1. */
void set_box(const set *s, size_t begin, size_t end, double low[3], double high[3]);

/* The hull of the elements begin ... end - 1, which refers to the vertices of the set. */
set set_group(const set *s, size_t begin, size_t end);

typedef struct mover {
  char id[256];
  bool none; /* there is no curve of this name to be asked about */
  double radius;
  curve curve, growth; /* growth: as of a set, of the radius */
  set *carried;        /* what is moved by the curve without turning; none: a point */
  size_t n_carried;
  struct robot *robot; /* or NULL: then it is the curve that moves */
} mover;

typedef struct problem {
  set *sets;
  size_t n_sets;
  mover mover; /* the one that was read last */
  char fault[300];
  char *line; /* the reader's */
  const char *first;
  size_t capacity, number;
  FILE *in;
} problem;

/* Reads the head. False, with a message in fault. */
bool problem_open(problem *p, FILE *in);

/* Reads the next mover, and before it obstacles that take the place of those there are. False at the end, or with a
 * message in fault. */
bool problem_next(problem *p);

void problem_close(problem *p);

#endif
