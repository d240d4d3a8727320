/* SPDX-License-Identifier: BSD-3-Clause */
/* A convex body {f <= 0} that is known by f and its derivatives: its support function, certified. doc/implicit.md */
#ifndef CPROX_SHAPE_CONVEX_FUNCTION_H
#define CPROX_SHAPE_CONVEX_FUNCTION_H

#include "curve_proximity/cprox/implicit.h"

typedef struct convex_function {
  cprox_convex_function given;
  double gap; /* of the radius: a support point may be so much short of the support value */
} convex_function;

#endif
