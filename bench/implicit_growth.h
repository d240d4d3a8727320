/* SPDX-License-Identifier: BSD-3-Clause */
/* Growth distances with their gradients, beside other ways to have them. */
#ifndef CPROX_BENCH_IMPLICIT_GROWTH_H
#define CPROX_BENCH_IMPLICIT_GROWTH_H

#include "curve_proximity/cprox/body.h"
#include "support/measure.h"

/* object: I to VI of the paper, from 1 on. */
void implicit_growths(const bench_size *size, cprox_body *const *object, cprox_workspace *workspace);

#endif
