/* SPDX-License-Identifier: BSD-3-Clause */
/* What meshes, points and boxes share: bodies made of a tree's elements. */
#ifndef CPROX_SHAPE_ELEMENTS_H
#define CPROX_SHAPE_ELEMENTS_H

#include "bvh/bvh.h"
#include "shape/body.h"

/* n points named "vertex 7": finite, not too large. */
cprox_status elements_check_points(const char *name, const vec3 *points, size_t n, cprox_workspace *workspace);

/* Whether there are some, few enough, and what they need is allowed. */
cprox_status elements_check_count(const char *names, tree_kind kind, size_t n, size_t extra, tree_build build,
                                  size_t memory_limit, cprox_workspace *workspace);

/* The body of the elements, enlarged by the margin, about the middle of the points that the source names. */
cprox_status elements_create(cprox_body_kind kind, tree_source *source, size_t n_points, tree_build build,
                             double margin, cprox_workspace *workspace, cprox_body **body);

/* The public queries. */
double elements_support(const cprox_body *body, vec3 direction, vec3 *point);
double elements_nearest(const cprox_body *body, vec3 point, vec3 *nearest);

/* Whether the inside belongs to the body: false for mesh surfaces only. */
bool elements_are_solid(const cprox_body *body);

/* The bytes that elements take; 0 for other bodies. */
size_t elements_bytes(const cprox_body *body);

#endif
