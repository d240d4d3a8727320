/* SPDX-License-Identifier: BSD-3-Clause */
/** Sets: many targets in one tree over their boxes. A mover tests itself once against the tree and then against what is
 *  near. */
#ifndef CURVE_PROXIMITY_CPROX_SET_H
#define CURVE_PROXIMITY_CPROX_SET_H

#include <curve_proximity/cprox/query.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Immutable once made; any number of threads may ask at once, each with its own workspace. */
typedef struct cprox_set cprox_set;

/** A set of n >= 0 targets. They are copied; the bodies and curves that they name are kept by reference and must
 *  outlive the set. Targets without bounds (halfspaces) and those on the mover's clock are allowed: they are asked
 *  every time.
 *  CPROX_INVALID where one is unusable, its number in the reason. Cost: n log n, and 6 support values a target. */
CPROX_API cprox_status cprox_set_create(const cprox_obstacle *targets, size_t n, cprox_workspace *workspace,
                                        cprox_set **set);

/** NULL is allowed. No query may be using it. */
CPROX_API void cprox_set_free(cprox_set *set);

/** How many targets it has. */
CPROX_API size_t cprox_set_size(const cprox_set *set);

/** The bytes it takes, without the bodies and curves. */
CPROX_API size_t cprox_set_bytes(const cprox_set *set);

/** As cprox_distance_all(), cprox_tolerance_all(), cprox_collision_all() and cprox_time_of_contact_all() with the
 *  targets of the set: the answer against their union, result->obstacle_index counting as they were given; robots, too.
 *  No certificates: CPROX_INVALID where one is asked for. */
CPROX_API cprox_status cprox_set_distance(const cprox_set *set, cprox_mover mover, const cprox_options *options,
                                          cprox_workspace *workspace, cprox_result *result);
CPROX_API cprox_status cprox_set_tolerance(const cprox_set *set, cprox_mover mover, double delta,
                                           const cprox_options *options, cprox_workspace *workspace,
                                           cprox_result *result);
CPROX_API cprox_status cprox_set_collision(const cprox_set *set, cprox_mover mover, const cprox_options *options,
                                           cprox_workspace *workspace, cprox_result *result);
CPROX_API cprox_status cprox_set_time_of_contact(const cprox_set *set, cprox_mover mover, const cprox_options *options,
                                                 cprox_workspace *workspace, cprox_result *result);

/** The k closest targets, as cprox_nearest() in clearance.h gives them: nearest receives min(k, size) results. */
CPROX_API cprox_status cprox_set_nearest(const cprox_set *set, cprox_mover mover, size_t k,
                                         const cprox_options *options, cprox_workspace *workspace,
                                         cprox_result *nearest, size_t *count);

#ifdef __cplusplus
}
#endif
#endif
