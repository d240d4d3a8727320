/* SPDX-License-Identifier: BSD-3-Clause */
/* When Newton's method along a piece ends. Steps are by the piece's parameter in [0, 1], whose unit roundoff is
 * 2^-53. */
#ifndef CPROX_CURVE_QUERY_NEWTON_STEPS_H
#define CPROX_CURVE_QUERY_NEWTON_STEPS_H

/* Nine roundings of the parameter: a shorter step is none. */
#define NEWTON_STANDS 1e-15

/* The method converges quadratically: after a step h the error is of order h^2. After a shorter step than this it is
 * 1e-18, below rounding. */
#define NEWTON_CONVERGED 1e-9

#endif
