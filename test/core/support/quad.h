/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers of at least long double's precision, of 113 bits where the compiler has them: what double-double arithmetic
 * (106 bits) is held against. Only + - * / are used, so no library is needed. */
#ifndef CPROX_TEST_QUAD_H
#define CPROX_TEST_QUAD_H

#include <float.h>

#include "curve/curve.h"
#include "support/random.h"

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 quad;
#define QUAD_U 0x1p-113
#else
typedef long double quad;
#define QUAD_U (0.5 * (double)LDBL_EPSILON)
#endif

typedef struct quad3 {
  quad k[3];
} quad3;

/* a + s b */
static inline quad3 quad_axpy(quad3 a, quad s, vec3 b) {
  return (quad3){{a.k[0] + s * (quad)b.x, a.k[1] + s * (quad)b.y, a.k[2] + s * (quad)b.z}};
}

static inline double quad_distance(quad3 a, quad3 b) {
  return vec_norm(vec((double)(a.k[0] - b.k[0]), (double)(a.k[1] - b.k[1]), (double)(a.k[2] - b.k[2])));
}

/* The piece that t belongs to, the left one at a joint that is the end of all. */
size_t quad_piece_at(const cprox_curve *c, double t);

/* The computed piece at t, by its Bernstein sum: within 4 degree QUAD_U max|control point|. */
quad3 quad_piece(const cprox_curve *c, size_t piece, double t);

/* An end of the range, a joint, or anything between. */
double quad_parameter(const cprox_curve *c, rng *r);

#endif
