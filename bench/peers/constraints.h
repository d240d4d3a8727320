/* SPDX-License-Identifier: BSD-3-Clause */
/* The constraints of an implicit body as general solvers want them. */
#ifndef CPROX_BENCH_PEERS_CONSTRAINTS_H
#define CPROX_BENCH_PEERS_CONSTRAINTS_H

#include "implicit/implicit.h"

/* Constraint k at x: its value, gradient and second derivative (xx, xy, xz, yy, yz, zz). A power below 2 has none at 0:
 * a large number stands for it. */
double constraint_at(const implicit *body, int32_t k, vec3 x, vec3 *gradient, double hessian[6]);

vec3 constraint_turn(const double *m, vec3 v);
vec3 constraint_turn_back(const double *m, vec3 v);

#endif
