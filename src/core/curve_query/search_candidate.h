/* SPDX-License-Identifier: BSD-3-Clause */
/* One search against one candidate: the oracle that it asks for, and what that found in the terms of the caller. */
#ifndef CPROX_CURVE_QUERY_SEARCH_CANDIDATE_H
#define CPROX_CURVE_QUERY_SEARCH_CANDIDATE_H

#include "problem/candidates.h"

/* Searches one candidate; *result holds its own interval and the witness. `cutoff`: an upper bound known from others. A
 * level-of-detail body is searched by its hull first where that may do, unless the candidate says which level of
 * detail. */
cprox_status candidate_search(const query *q, const candidate *c, double cutoff, cprox_result *result);

/* Whether it has a hull that could spare the search of its mesh. */
bool candidate_may_refine(const query *q, const candidate *c);

/* Where nothing is known yet, the hull says how far a level-of-detail body is at least, to one part in a hundred:
 * raises c->lower, and from then on it is the mesh that is searched. */
cprox_status candidate_rank(const query *q, candidate *c, uint32_t *nodes, uint32_t *distance_queries);

/* The hull of a level-of-detail body is out of the query. Where it came closest, at result->t, the mesh is measured:
 * *result gets a witness of its own, and an upper bound. */
cprox_status candidate_measure_mesh(const query *q, const candidate *c, cprox_result *result);

#endif
