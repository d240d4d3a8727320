/* SPDX-License-Identifier: BSD-3-Clause */
/* The left-to-right oracle of two balls on two curves: where along the first do they first touch, wherever the second
 * one is? It is curve_curve with another place to measure, the left end of the first curve's interval and the point of
 * the second that is nearest to it, and another place to cut. doc/time-of-contact.md derives it. */
#ifndef CPROX_CURVE_QUERY_CONTACT_CURVE_H
#define CPROX_CURVE_QUERY_CONTACT_CURVE_H

#include "curve_query/curve_curve.h"

typedef struct contact_curve {
  curve_curve base;     /* its best meeting is the leftmost within epsilon; while there is none, the nearest */
  double epsilon;       /* distances up to this are contact */
  curve_meeting proven; /* the leftmost meeting at which they certainly touch */
  search_best proven_bound;
  double
      nearest; /* where the last probe found the second curve nearest, by its piece's parameter; -1: it did not look */
} contact_curve;

/* Makes an oracle out of one that has begun. */
void contact_curve_begin(contact_curve *c, double epsilon);

search_node contact_curve_root(const contact_curve *c);
search_oracle contact_curve_oracle(contact_curve *c);

/* After the search: a contact that is nearer than epsilon but not proven becomes proven a little farther along, if a
 * few measurements there succeed. */
void contact_curve_prove(contact_curve *c);

#endif
