/* SPDX-License-Identifier: BSD-3-Clause */
/* The left-to-right oracle of a ball that rides a curve against a mesh, points or boxes: curve_tree with another place
 * to measure and to cut, as contact_convex is to curve_convex. doc/time-of-contact.md and doc/non-convex.md derive it.
 */
#ifndef CPROX_CURVE_QUERY_CONTACT_BVH_H
#define CPROX_CURVE_QUERY_CONTACT_BVH_H

#include "curve_query/curve_bvh.h"

typedef struct contact_tree {
  curve_tree base;    /* its best sample is the leftmost within epsilon; while there is none, the nearest */
  tree_sample proven; /* the leftmost sample at which they certainly touch */
  search_best proven_bound;
  bool proven_within; /* contact is proven between the sample and */
  double proven_t;    /* this parameter */
  double share;       /* how much of the node that was probed last is free, */
  double ahead; /* and where contact would be if the nearest element were approached as at its beginning; infinity:
                   nowhere */
} contact_tree;

/* Makes an oracle out of one that has begun; base.asked must be set. False where memory is out. */
bool contact_tree_begin(contact_tree *c, search_node *root);
search_oracle contact_tree_oracle(contact_tree *c);

/* As contact_convex_prove(). */
void contact_tree_prove(contact_tree *c);

#endif
