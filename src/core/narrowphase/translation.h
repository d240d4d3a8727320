/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies that translate: what growth distances take from there. */
#ifndef CPROX_NARROWPHASE_TRANSLATION_H
#define CPROX_NARROWPHASE_TRANSLATION_H

#include "base/vec.h"
#include "curve_proximity/cprox/translation.h"

/* Whether the obstacle, called `name`, is one convex body. */
cprox_status translation_check_body(const char *name, const cprox_obstacle *obstacle, cprox_workspace *workspace);

/* The growth distance by pairs: b comes from far along the line of the centres until both touch. inner: the radii of
 * balls inside, summed. growth->status says how it ended; what is returned is an error or CPROX_OK. */
cprox_status translation_growth(cprox_obstacle a, cprox_obstacle b, double inner, const cprox_options *asked,
                                cprox_workspace *workspace, cprox_growth *growth);

#endif
