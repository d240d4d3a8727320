/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/exact.h"

#include <stdlib.h>

enum { BITS = 320, MOST = 1 << 17 };

static mpfr_t row[MOST];
static size_t used, made;

static num next(void) {
  if (used == MOST) abort(); /* a test that forgot to reset */
  if (used == made) mpfr_init2(row[made++], BITS);
  return row[used++];
}

void exact_reset(void) {
  used = 0;
}

void exact_free(void) {
  while (made > 0) mpfr_clear(row[--made]);
  used = 0;
  mpfr_free_cache();
}

num exact(double a) {
  num out = next();
  mpfr_set_d(out, a, MPFR_RNDN);
  return out;
}

#define BINARY(name, function)      \
  num name(num a, num b) {          \
    num out = next();               \
    function(out, a, b, MPFR_RNDN); \
    return out;                     \
  }

#define UNARY(name, function)    \
  num name(num a) {              \
    num out = next();            \
    function(out, a, MPFR_RNDN); \
    return out;                  \
  }

BINARY(exact_add, mpfr_add)
BINARY(exact_sub, mpfr_sub)
BINARY(exact_mul, mpfr_mul)
BINARY(exact_div, mpfr_div)
BINARY(exact_max, mpfr_max)
BINARY(exact_min, mpfr_min)
UNARY(exact_root, mpfr_sqrt)
UNARY(exact_cos, mpfr_cos)
UNARY(exact_sin, mpfr_sin)

double exact_double(num a) {
  return mpfr_get_d(a, MPFR_RNDN);
}

num3 exact3(vec3 a) {
  return (num3){{exact(a.x), exact(a.y), exact(a.z)}};
}

num3 exact3_sub(num3 a, num3 b) {
  return (num3){{exact_sub(a.k[0], b.k[0]), exact_sub(a.k[1], b.k[1]), exact_sub(a.k[2], b.k[2])}};
}

num3 exact3_blend(num3 a, num3 b, num s) {
  num3 out;
  for (int k = 0; k < 3; k++) out.k[k] = exact_add(a.k[k], exact_mul(s, exact_sub(b.k[k], a.k[k])));
  return out;
}

num exact3_dot(num3 a, num3 b) {
  return exact_add(exact_add(exact_mul(a.k[0], b.k[0]), exact_mul(a.k[1], b.k[1])), exact_mul(a.k[2], b.k[2]));
}

num exact3_norm(num3 a) {
  return exact_root(exact3_dot(a, a));
}

double exact3_error(num3 a, vec3 b) {
  return exact_double(exact3_norm(exact3_sub(a, exact3(b))));
}
