/* SPDX-License-Identifier: BSD-3-Clause */
/* Time of contact with a union, some obstacles at a time. */
#ifndef CPROX_SOLVE_TIME_OF_CONTACT_H
#define CPROX_SOLVE_TIME_OF_CONTACT_H

#include "solve/solve.h"

/* What one candidate, or all so far, say of time of contact. */
typedef struct time_of_contact {
  double free_until;  /* no contact before */
  double lower;       /* of the distance, over the whole range */
  cprox_result touch; /* t: the leftmost parameter of proven contact, or infinity; upper <= 0 */
  cprox_result
      near; /* t: that of contact within epsilon, or infinity; if there is none, upper is the least distance measured */
  double slack;   /* of what was measured there */
  double near_at; /* near.t, rounded down as free_until is */
  uint32_t nodes, distance_queries;
  cprox_lod lod;       /* the finest that was needed */
  cprox_status status; /* CPROX_OK: free_until is as far as it goes, to within epsilon of contact */
} time_of_contact;

/* With nothing. */
time_of_contact time_of_contact_begin(void);

/* Adds obstacles first … last - 1. CPROX_OK, or a negative status. */
cprox_status time_of_contact_with(time_of_contact *all, const query *q, size_t first, size_t last);

/* What that says to the caller. */
cprox_status time_of_contact_conclude(const time_of_contact *all, const query *q, cprox_result *result);

#endif
