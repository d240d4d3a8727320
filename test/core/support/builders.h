/* SPDX-License-Identifier: BSD-3-Clause */
/* What tests of queries begin with: a workspace of the program's own, and curves that fail the test where they cannot
 * be made. */
#ifndef CPROX_TEST_BUILDERS_H
#define CPROX_TEST_BUILDERS_H

#include "base/vec.h"
#include "curve_proximity/cprox.h"

extern cprox_workspace *ws;

/* For cases_run(). */
int workspace_setup(void **state);
int workspace_teardown(void **state);

/* On [0, 1]. */
cprox_curve *bezier(const vec3 *points, size_t n);

/* The defaults, with this epsilon. */
cprox_options accurate(double epsilon);

#endif
