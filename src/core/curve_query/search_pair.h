/* SPDX-License-Identifier: BSD-3-Clause */
/* One search against one candidate: the oracle that it asks for, and what that found in the terms of the caller. */
#ifndef CPROX_CURVE_QUERY_SEARCH_PAIR_H
#define CPROX_CURVE_QUERY_SEARCH_PAIR_H

#include "curve_query/curve_bvh.h"
#include "curve_query/curve_convex.h"
#include "curve_query/curve_curve.h"
#include "problem/placed_pair.h"

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

/* The oracle of a pair with a convex shape, ready to search; false where memory is out. */
bool placed_begin_convex(const query *q, const placed_pair *p, curve_convex *o);

/* Parameter, points and normal of its best sample, if it has one. CPROX_OK, or a negative status. */
cprox_status placed_report_convex(const query *q, const placed_pair *p, const curve_convex *o, cprox_result *r);

/* The same of an obstacle made of many elements: a mesh, points, boxes. */
bool placed_is_tree(const placed_pair *p);
bool placed_begin_tree(const query *q, const placed_pair *p, curve_tree *o);
void placed_report_tree(const query *q, const placed_pair *p, const curve_tree *o, cprox_result *r);

/* The same of an obstacle that is a curve. */
bool placed_begin_curve(const query *q, const placed_pair *p, curve_curve *o);
cprox_status placed_report_curve(const query *q, const placed_pair *p, const curve_curve *o, cprox_result *r);

#endif
