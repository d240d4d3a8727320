/* SPDX-License-Identifier: BSD-3-Clause */
/* The one handle over every set, and the parts it is made of. */
#ifndef CPROX_SHAPE_BODY_H
#define CPROX_SHAPE_BODY_H

#include "base/frame.h"
#include "base/rounding.h"
#include "convex/convex.h"
#include "curve_proximity/cprox/body.h"

typedef struct body_part {
  const cprox_body *body; /* convex */
  cprox_pose pose;        /* in the frame of the union */
} body_part;

struct cprox_body {
  cprox_body_kind kind;
  convex shape; /* convex kinds: about `centre` */
  vec3 centre;  /* where the shape's origin stands in the body's frame */
  vec3 ball_centre;
  double ball_radius;
  body_part *parts; /* compounds */
  size_t n_parts;
  struct tree
      *tree; /* meshes, points, boxes: the elements, about `centre`; the shape has the margin and the scale alone */
  bool borrows_tree;                /* the tree belongs to another body */
  struct winding *winding;          /* solid meshes: what tells inside from outside */
  const cprox_body *hull, *mesh;    /* level-of-detail bodies: the two models, */
  struct distance_field *field;     /* sets known by their distance: the function, in the body's frame */
  struct convex_function *function; /* convex bodies by a function: it, what the support callback is given */
  double excess;                    /* how far the mesh may stick out of the hull, */
  struct cluster_hulls *clusters;   /* and of a mesh of triangles what is between the two */
};

/* A compound's convex parts; any other body is the one part of its own, and so is no body at all. */
static inline size_t body_n_parts(const cprox_body *body) {
  return body && body->kind == CPROX_BODY_COMPOUND ? body->n_parts : 1;
}

static inline const cprox_body *body_part_at(const cprox_body *body, size_t part) {
  return body && body->kind == CPROX_BODY_COMPOUND ? body->parts[part].body : body;
}

/* Whether it keeps within what queries can hold; of a halfspace the distance of its plane counts. */
static inline bool body_is_in_reach(const cprox_body *body) {
  const vec3 c = body->ball_centre;
  const double radius = isinf(body->ball_radius) ? body->shape.scale : body->ball_radius;
  return radius <= LENGTH_MOST && fabs(c.x) <= LENGTH_MOST && fabs(c.y) <= LENGTH_MOST && fabs(c.z) <= LENGTH_MOST;
}

#endif
