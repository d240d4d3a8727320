/* SPDX-License-Identifier: BSD-3-Clause */
/* Levels of detail between a mesh's hull and its triangles: the convex hull of the triangles under each lane of the
 * mesh's tree. A hull is kept as its vertices, the inner ones among them. doc/robot-search.md, Meshes */
#ifndef CPROX_SHAPE_CLUSTER_HULLS_H
#define CPROX_SHAPE_CLUSTER_HULLS_H

#include <stdatomic.h>

#include "bvh/bvh.h"
#include "convex/few_points.h"

typedef struct cluster_hull {
  convex shape;                /* about the centre */
  vec3 centre, half;           /* of the smallest box that contains the hull; the centre in the tree's frame */
  double radius;               /* of a ball about the centre that contains it */
  uint32_t inside[TREE_LANES]; /* the hulls that it consists of, or with TREE_LEAF elements: pack * TREE_LANES + lane */
  uint32_t count;
} cluster_hull;

typedef struct cluster_hulls {
  size_t n;
  cluster_hull *hull; /* the first one is of all elements */
  size_t n_vertices;  /* numbers */
  double *vertices;
  _Atomic(few_points *) *few; /* of each hull: cluster_hulls_few() */
} cluster_hulls;

/* Of a tree of triangles. NULL where memory is out. */
cluster_hulls *cluster_hulls_create(const tree *t);
void cluster_hulls_free(cluster_hulls *hulls);

/* Few points of a hull, about its centre: made when they are first asked for; any number of threads may ask. NULL where
 * memory is out. */
const few_points *cluster_hulls_few(const cluster_hulls *hulls, size_t hull);

/* What they take: about 160 bytes a triangle. */
size_t cluster_hulls_bytes(const cluster_hulls *hulls);

#endif
