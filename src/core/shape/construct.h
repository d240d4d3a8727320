/* SPDX-License-Identifier: BSD-3-Clause */
/* What the constructors of convex bodies and of compounds share. */
#ifndef CPROX_SHAPE_CONSTRUCT_H
#define CPROX_SHAPE_CONSTRUCT_H

#include "shape/body.h"

/* An empty body of the kind, ops NULL for compounds; NULL where memory is out. */
cprox_body *body_allocate(const convex_ops *ops, cprox_body_kind kind);

cprox_status body_out_of_memory(cprox_workspace *workspace);

/* The public queries, of a compound. */
double compound_support(const cprox_body *body, vec3 direction, vec3 *point);
double compound_nearest(const cprox_body *body, vec3 point, vec3 *nearest);

#endif
