/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs whose signed distance is a formula, known by the two kinds before anything is placed. */
#ifndef CPROX_NARROWPHASE_FORMULA_H
#define CPROX_NARROWPHASE_FORMULA_H

#include "convex/pair.h"
#include "curve_proximity/cprox/query.h"

/* Points, balls and capsules among each other; points and balls against every shape with a closed form. The answer is
 * in the world. False: the kinds have no formula, or a search could make the interval narrower. */
bool pair_by_formula(const cprox_obstacle *a, const cprox_obstacle *b, pair_answer *answer);

#endif
