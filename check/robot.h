/* SPDX-License-Identifier: BSD-3-Clause */
/* A robot along a motion, as the problem's text describes it: single axes, convex bodies on them, and a Bézier
 * polynomial for each segment and variable. */
#ifndef CHECK_ROBOT_H
#define CHECK_ROBOT_H

#include "ball.h"
#include "problem.h"

struct words;

enum { ROBOT_MAX_DEGREE = 9 };

typedef enum axis_kind { AXIS_TURN, AXIS_SHIFT, AXIS_QUATERNION, AXIS_ARC } axis_kind;

/* A rotation about z or a shift along it by multiplier * variable + offset; or a rotation by the quaternion of four
 * variables (x, y, z, w), the first of which is the angle of an arc where it turns by slerp. */
typedef struct axis {
  axis_kind kind;
  int parent; /* -1: the world */
  place at;   /* in the parent's moved frame */
  num z[3];
  size_t variable;
  double multiplier, offset;
  bool moves;
  double least; /* of a quaternion's length over the whole motion */
} axis;

/* Where links hang. */
typedef struct hook {
  int axis;
  place at;
} hook;

/* A convex set on an axis, -1: one that stands, which may be a union of elements. */
typedef struct body {
  const set *shape;
  int axis;
  place at;                  /* of the set's own frame, moved to the set's centre */
  double radius;             /* about the centre, without margin */
  double middle[3], half[3]; /* of a box about it in its own frame; only to choose by */
} body;

/* What stands, or a part of its elements. */
typedef struct item {
  size_t begin, end;                          /* elements; not of a convex body */
  double middle[3], half[3], low[3], high[3]; /* boxes, about the body's centre: to choose by; of all vertices */
  int depth;                                  /* of cuts */
  size_t inner;                               /* the first of the two that it is cut into; 0: it is not */
  vec normal;                                 /* the last one given, in the frame of what stands */
  num reach;                                  /* of a body by inequalities along it, about its centre */
  bool given;
} item;

typedef struct pair {
  size_t moving, standing; /* bodies */
  item *items;             /* while a certificate is read: the first one is the whole */
  size_t n_items, room;
} pair;

/* Over a segment of the motion: a rotation by `angle` about z, from where it begins. */
typedef struct slerp_arc {
  bool used;
  num z[3], angle;
  rot start;
} slerp_arc;

typedef struct robot {
  size_t n_links, n_axes, n_parts, n_bodies, n_pairs, n_variables, n_segments;
  hook *links;
  axis *axes; /* parents first */
  set *parts;
  body *bodies; /* the parts, then the problem's obstacles */
  pair *pairs;
  double *rest;
  bool *moved;     /* which variables the motion speaks of */
  double *times;   /* n_segments + 1 */
  size_t *degrees; /* of a segment */
  num *points;     /* [segment][variable][ROBOT_MAX_DEGREE + 1]; not of variables that are not moved */
  slerp_arc *arcs; /* [segment][axis] */
} robot;

/* Reads what follows "robot ID"; NULL with a message in the problem's fault. */
robot *robot_read(problem *p, struct words *w);
void robot_forget(robot *r);

static inline const num *robot_points(const robot *r, size_t segment, size_t variable) {
  return r->points + (segment * r->n_variables + variable) * (ROBOT_MAX_DEGREE + 1);
}

#endif
