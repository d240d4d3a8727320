/* SPDX-License-Identifier: BSD-3-Clause */
/* The arguments of the verbs: defaults, names, and the sentences for those that are unusable. */
#ifndef CPROX_PROBLEM_VALIDATE_H
#define CPROX_PROBLEM_VALIDATE_H

#include "curve_proximity/cprox/query.h"

/* CPROX_OK, or CPROX_INVALID with a sentence that names the argument. */
cprox_status arguments_check_options(const cprox_options *options, cprox_workspace *workspace);
cprox_status arguments_check_delta(double delta, cprox_workspace *workspace);
cprox_status arguments_check_target(const cprox_target *target, size_t index, cprox_workspace *workspace);
cprox_status arguments_check_targets(const cprox_target *targets, size_t n, cprox_workspace *workspace);
cprox_status arguments_check_query(const cprox_mover *mover, const cprox_target *targets, size_t n,
                                   const cprox_options *options, cprox_workspace *workspace);

#endif
