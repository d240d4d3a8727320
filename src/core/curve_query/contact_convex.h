/* SPDX-License-Identifier: BSD-3-Clause */
/* The left-to-right oracle of a ball that rides a curve against a convex body: where do they first touch? It is
 * curve_convex with another place to measure, the left end of an interval, and another place to cut, the end of what
 * that measurement proves free. doc/time-of-contact.md derives it. */
#ifndef CPROX_CURVE_QUERY_CONTACT_CONVEX_H
#define CPROX_CURVE_QUERY_CONTACT_CONVEX_H

#include "curve_query/curve_convex.h"

typedef struct contact_convex {
  curve_convex base;   /* its best sample is the leftmost within epsilon; while there is none, the nearest */
  double epsilon;      /* distances up to this are contact */
  curve_sample proven; /* the leftmost sample at which they certainly touch */
  search_best proven_bound;
  bool proven_within; /* contact is proven between the sample and */
  double proven_t;    /* this parameter */
} contact_convex;

/* Makes an oracle out of one that has begun. */
void contact_convex_begin(contact_convex *c, double epsilon);

search_node contact_convex_root(const contact_convex *c);
search_oracle contact_convex_oracle(contact_convex *c);

/* After the search: a contact that is nearer than epsilon but not proven becomes proven a little farther along, if a
 * few measurements there succeed. */
cprox_status contact_convex_prove(contact_convex *c);

#endif
