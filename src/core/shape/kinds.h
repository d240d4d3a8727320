/* SPDX-License-Identifier: BSD-3-Clause */
/* What sets one kind of body apart from the others: one row a kind. Convex kinds have a second row, their convex_ops,
 * for what the shape alone can do. */
#ifndef CPROX_SHAPE_KINDS_H
#define CPROX_SHAPE_KINDS_H

#include "shape/body.h"

typedef struct body_kind {
  const char *name; /* of cprox_body_kind_name(), and in certificates */

  /* The public queries. */
  double (*support_of)(const cprox_body *body, vec3 direction, vec3 *point);
  double (*nearest_of)(const cprox_body *body, vec3 point, vec3 *nearest);

  /* Batches: the nearest point is cheap and certain, and tells how deep a point lies inside. */
  bool has_cheap_depth;

  /* Level of detail: the bounding sphere never stands in for it. */
  bool is_own_sphere;

  /* Certificates: the checker knows the kind. It is described by so many entries of shape.size, in this order; kinds
   * with vertices by those. */
  bool has_certificate;
  int n_sizes, sizes[4];

  /* The radius of a ball about the origin of a shape with sizes that lies in it; NULL: none is known. */
  double (*inner_radius)(const convex *shape);
} body_kind;

const body_kind *body_kind_of(cprox_body_kind kind);

#endif
