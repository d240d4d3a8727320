/* SPDX-License-Identifier: BSD-3-Clause */
/** Many movers against the same targets.
 *
 *  The targets are made ready once; then any number of threads answer ranges of the movers, each with its own
 *  workspace. Nothing that is shared is written, and each answer depends on its mover alone: results are the same for
 *  every split into ranges, every number of threads and every instruction set. */
#ifndef CURVE_PROXIMITY_CPROX_BATCH_H
#define CURVE_PROXIMITY_CPROX_BATCH_H

#include <curve_proximity/cprox/query.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Targets made ready for batches; immutable. */
typedef struct cprox_batch cprox_batch;

/** Makes n targets ready: a bounding ball, an inscribed ball and a box round each part.
 *
 *  targets   copied; what they name is kept by reference and must outlive the batch. n = 0: nothing to meet.
 *  batch     receives the handle, owned by the caller: cprox_batch_free(). Untouched on failure.
 *
 *  CPROX_INVALID for a target that is unusable, its number in the reason; CPROX_MEMORY. Cost: about fifty nearest-point
 *  queries for each convex part. */
CPROX_API cprox_status cprox_batch_create(const cprox_obstacle *targets, size_t n, cprox_workspace *workspace,
                                          cprox_batch **batch);

/** Frees a batch; NULL is allowed. No query may be using it. */
CPROX_API void cprox_batch_free(cprox_batch *batch);

/** Distance of movers first … last - 1 from the union of the batch's targets.
 *
 *  movers    at least `last` of them; first <= last.
 *  options   NULL: the default. A certificate is refused: ask the query of one mover for it.
 *  results   results[i] receives what cprox_distance_all() answers for movers[i]: the same guarantees, not the same
 *            digits. Signed distances are searched one mover at a time.
 *            The others are untouched. nodes and distance queries are 0 where balls and boxes round the parts settled
 *            it.
 *
 *  A mover that is unusable fails alone: its result has the negative status and the interval [0, infinity], all others
 *  are answered. Returns the first negative status, else the largest; the reason names the first mover that it belongs
 *  to. Where batch, movers, results, options or the range are unusable: CPROX_INVALID, and nothing is written.
 *  Source: doc/batches.md. */
CPROX_API cprox_status cprox_batch_distance(const cprox_batch *batch, const cprox_mover *movers, size_t first,
                                            size_t last, const cprox_options *options, cprox_workspace *workspace,
                                            cprox_result *results);

/** The same for cprox_tolerance_all(). delta >= 0 [m]. */
CPROX_API cprox_status cprox_batch_tolerance(const cprox_batch *batch, const cprox_mover *movers, size_t first,
                                             size_t last, double delta, const cprox_options *options,
                                             cprox_workspace *workspace, cprox_result *results);

/** The same for cprox_collision_all(). */
CPROX_API cprox_status cprox_batch_collision(const cprox_batch *batch, const cprox_mover *movers, size_t first,
                                             size_t last, const cprox_options *options, cprox_workspace *workspace,
                                             cprox_result *results);

#ifdef __cplusplus
}
#endif
#endif
